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

COMPARED = ("status", "score", "metrics", "steps")  # what makes two runs the same


def read_rows(folder: Path, begun: bool = False) -> list[dict[str, Any]]:
    """The runs of a result; `begun`: without a last line that a writer that died left unfinished.

    Raises:
        BadResult: The folder is not a result, or the result is damaged.
    """
    path = folder / "evaluations.jsonl"
    rows: list[dict[str, Any]] = []
    try:
        text = path.read_text(encoding="utf-8")
        text = text[: text.rfind("\n") + 1] if begun else text
        for number, line in enumerate(text.splitlines(), start=1):
            row = json.loads(line)
            tables = (row["settings"], row["metrics"], row.get("values", {}))
            if not all(isinstance(table, dict) for table in tables) or not {*COMPARED} <= {*row}:
                raise ValueError(f"line {number} is no run")
            rows.append(row)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BadResult(Fault(f"this cannot be read ({error}); restore it from a copy.", Mark(str(path)))) from error
    return rows


def outcome_of(row: Mapping[str, Any], step: float) -> Outcome:
    """How a run ended that was read;

    Args:
        step: Of its model, in s.
    """
    metrics = {name: math.nan if value is None else float(value) for name, value in row["metrics"].items()}
    return Outcome(row["status"], row["reason"], row["steps"], step, metrics, row["score"], 0.0)


def pick_row(folder: Path, which: str) -> int:
    """The place, from 0, of the run that `best` or its number, from 1, names.

    Best is the lowest score; without scores the first run that did not fail, or else the first.

    Raises:
        BadResult: The folder is not a result, or the result is damaged.
        Usage: A word that names none.
    """
    rows = read_rows(folder)
    if not rows:
        raise BadResult(f"{folder}: it holds no run; make it anew with gaitsim run.")
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
    """Whose run it is, of a cohort, and what was set in it: gain = 2, ...; or which draw it is; empty if neither."""
    said = [f"{address} = {value}" for address, value in row["settings"].items()]
    whose = [str(row["body"])] if "body" in row else []
    return ", ".join([*whose, *said, *([f"draw {row['draw']}"] if "draw" in row else [])])


def row_starts(row: Mapping[str, Any]) -> dict[str, float]:
    """The tuned values that a run has of its own, as a draw does, in SI, by address."""
    return {str(address): float(value) for address, value in row.get("values", {}).items()}
