"""Tables of a search: generations.csv and parameters.csv, written anew from the journal."""

from __future__ import annotations

import csv
import io
import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np

from gaitsim.optimization.evaluation import Evaluation
from gaitsim.optimization.problem import Problem

GENERATIONS = "generations.csv"
# "spread" is the standard deviation of the scores; the column keeps the name that it has in files of older searches.
_COLUMNS = ("generation", "evaluations", "best", "generation_best", "median", "spread", "failed")


@dataclass(frozen=True)
class Generation:
    """The scores of one generation. Statistics are over the candidates with a score."""

    generation: int
    evaluations: int
    best: float
    generation_best: float
    median: float
    deviation: float
    failed: int

    def row(self) -> list[str]:
        return [
            str(self.generation),
            str(self.evaluations),
            *(_text(v) for v in (self.best, self.generation_best, self.median, self.deviation)),
            str(self.failed),
        ]


def generation_of(number: int, so_far: int, best: float, evaluations: Sequence[Evaluation]) -> Generation:
    """Summarize a generation.

    Args:
        number: Its number.
        so_far: The number of evaluations so far.
        best: The lowest score so far, this generation included.
        evaluations: Its evaluations.
    """
    scores = [e.verdict.score for e in evaluations if e.verdict.score is not None]
    failed = len(evaluations) - len(scores)
    if not scores:
        return Generation(number, so_far, best, math.inf, math.inf, math.nan, failed)
    deviation = statistics.pstdev(scores)
    return Generation(number, so_far, best, min(scores), statistics.median(scores), deviation, failed)


class GenerationsFile:
    """generations.csv: one row per generation, flushed at once."""

    def __init__(self, folder: Path) -> None:
        self._stream: IO[str] = (folder / GENERATIONS).open("w", encoding="utf-8", newline="")
        self._stream.write(_row(_COLUMNS))

    def add(self, generation: Generation) -> None:
        self._stream.write(_row(generation.row()))
        self._stream.flush()

    def close(self) -> None:
        self._stream.close()


def parameters_csv(
    problem: Problem,
    best: Sequence[float] | None,
    last: Sequence[Evaluation],
) -> str:
    """Bounds, start and best value of each tuned number, and the distribution of the better half of the last
    generation.

    Args:
        problem: The tuned numbers; each row is in the unit of its number.
        best: The best values in SI, if any.
        last: The evaluations of the last generation.

    Returns:
        The text of parameters.csv.
    """
    rows = [_row(("address", "unit", "low", "high", "start", "spread", "best", "mean", "std"))]
    scored = sorted((e for e in last if not e.failed), key=lambda e: e.cost)
    half = np.array([e.candidate.x for e in scored[: max(1, len(scored) // 2)]])
    for i, v in enumerate(problem.variables):
        found = math.nan if best is None else best[i]
        mean, std = (float(half[:, i].mean()), float(half[:, i].std())) if half.size else (math.nan, math.nan)
        numbers = (v.low, v.high, v.start, v.spread, found, mean, std)
        rows.append(_row((v.address, v.unit.text, *(_text(v.unit.of(n)) for n in numbers))))
    return "".join(rows)


def _text(number: float) -> str:
    return repr(float(number)) if math.isfinite(number) else ""


def _row(cells: Sequence[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(cells)
    return text.getvalue()
