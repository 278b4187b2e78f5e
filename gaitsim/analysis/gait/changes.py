"""Differences between the gaits of several walkers: each quantity of each run beside that of the first run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from gaitsim.analysis.drawings.style import shown_unit
from gaitsim.analysis.drawings.table import Table, formatted
from gaitsim.analysis.gait.comparison import matched_signals
from gaitsim.analysis.gait.legs import two_legs
from gaitsim.analysis.gait.numbers import gait_numbers
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay
from gaitsim.units import parse_unit

_ROUNDING = 9  # decimals; smaller differences are rounding errors


def gait_changes(replays: Sequence[Replay]) -> dict[str, dict[str, Any]]:
    """The gaits of several runs as data.

    Args:
        replays: Any number of runs; those that do not walk on two legs have no values.

    Returns:
        For each quantity its unit, and `values` by label of the run: means over the strides of both legs. Curves with
            recorded
        data of people have their value at touchdown, and their maximum and minimum over the cycle. Empty unless two of
            the runs walk.
    """
    found: dict[str, dict[str, Any]] = {}
    walkers = [replay for replay in replays if two_legs(replay) is not None]
    for replay in walkers if len(walkers) > 1 else ():
        for name, unit, value in _quantities(replay):
            found.setdefault(name, {"unit": unit, "values": {}})["values"][replay.label] = value
    return found


def _quantities(replay: Replay) -> Iterator[tuple[str, str, float | None]]:
    for name, row in gait_numbers(replay).items():
        if "mean" in row:
            yield name, row["unit"], row["mean"]
    for one in matched_signals(replay, two_legs(replay) or ()):
        curve: Floats = (
            np.mean([cycle.mean for cycle in one.cycles.values()], axis=0) / parse_unit(one.norm.unit).factor
        )
        name = one.name.replace(" ", "_")
        yield f"{name}_at_touchdown", one.norm.unit, float(curve[0])
        yield f"{name}_highest", one.norm.unit, float(np.max(curve))
        yield f"{name}_lowest", one.norm.unit, float(np.min(curve))


def changes_table(replays: Sequence[Replay]) -> Table | None:
    """The gaits of several runs as a table: the values of the first run, and those of the others with the change in
    brackets.
    """
    found = gait_changes(replays)
    labels = list(dict.fromkeys(label for row in found.values() for label in row["values"]))
    if not labels:
        return None
    rows = tuple(
        (name, shown_unit(row["unit"]), *_cells([row["values"].get(label) for label in labels]))
        for name, row in found.items()
    )
    return Table(("gait", "unit", *labels), rows, frozenset(range(2, 2 + len(labels))))


def _cells(values: Sequence[float | None]) -> Iterator[str]:
    first = values[0]
    yield _formatted(first)
    for value in values[1:]:
        if first is None or value is None:
            yield _formatted(value)
            continue
        change = round(value - first, _ROUNDING)
        sign = "+" if change > 0 else ""
        yield f"{_formatted(value)} ({sign}{formatted(change, 2)})"


def _formatted(value: float | None) -> str:
    return formatted(None if value is None else round(value, _ROUNDING), 3)
