"""The runs of a result: one, or one for each row of a study."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gaitsim.errors import Fault, Mark, Usage
from gaitsim.results.manifest import BadResult
from gaitsim.simulation.outcome import Outcome

COMPARED = ("status", "score", "metrics", "steps")  # what two equal runs have in common


def read_rows(folder: Path, incomplete: bool = False) -> list[dict[str, Any]]:
    """Read the runs of a result.

    Args:
        folder: The result.
        incomplete: Whether to skip an incomplete last line, which a writer that died may have left.

    Raises:
        BadResult: The runs cannot be read.
    """
    path = folder / "evaluations.jsonl"
    rows: list[dict[str, Any]] = []
    try:
        text = path.read_text(encoding="utf-8")
        text = text[: text.rfind("\n") + 1] if incomplete else text
        for number, line in enumerate(text.splitlines(), start=1):
            row = json.loads(line)
            tables = (row["settings"], row["metrics"], row.get("values", {}))
            if not all(isinstance(table, dict) for table in tables) or not {*COMPARED} <= {*row}:
                raise ValueError(f"line {number} is not a run")
            rows.append(row)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BadResult(Fault(f"this cannot be read ({error}); restore it from a copy.", Mark(str(path)))) from error
    return rows


def outcome_of(row: Mapping[str, Any], step: float) -> Outcome:
    """The outcome of a stored run.

    Args:
        row: The run.
        step: The step of its model, in s.
    """
    metrics = {name: math.nan if value is None else float(value) for name, value in row["metrics"].items()}
    return Outcome(row["status"], row["reason"], row["steps"], step, metrics, row["score"], 0.0)


def pick_row(folder: Path, which: str) -> int:
    """Find a run.

    The best run has the lowest score. Without scores it is the first run that did not fail, or else the first.

    Args:
        folder: The result.
        which: `best` or the number of a run, from 1.

    Returns:
        The index of the run, from 0.

    Raises:
        BadResult: The runs cannot be read.
        Usage: There is no such run.
    """
    rows = read_rows(folder)
    if not rows:
        raise BadResult(f"{folder}: it holds no run; make it again with gaitsim run.")
    if which == "best":
        scored = [i for i, row in enumerate(rows) if row["score"] is not None]
        if scored:
            return min(scored, key=lambda i: float(rows[i]["score"]))
        return next((i for i, row in enumerate(rows) if row["status"] != "failed"), 0)
    if not (which.isdecimal() and 1 <= int(which) <= len(rows)):
        rule = f"{folder} has the runs 1 to {len(rows)}" if len(rows) > 1 else f"{folder} holds one run"
        raise Usage(f"--candidate {which}: {rule}; write best, or the number of one.")
    return int(which) - 1


def row_words(row: Mapping[str, Any]) -> str:
    """What distinguishes a run: its body in a cohort, its settings such as gain = 2, or its draw; empty if nothing
    does.
    """
    settings = [f"{address} = {value}" for address, value in row["settings"].items()]
    whose = [str(row["body"])] if "body" in row else []
    return ", ".join([*whose, *settings, *([f"draw {row['draw']}"] if "draw" in row else [])])


def row_starts(row: Mapping[str, Any]) -> dict[str, float]:
    """The run's own tuned values, such as those of a draw, in SI by address."""
    return {str(address): float(value) for address, value in row.get("values", {}).items()}
