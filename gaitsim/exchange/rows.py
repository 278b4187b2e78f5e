"""Tables of numbers as text that reads back exactly; a file is complete or absent."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import IO

from gaitsim.simulation.outcome import Trajectory
from gaitsim.whole import whole

_BLOCK = 10_000  # rows that are converted to text at once


def write_table(path: Path, head: str, trajectory: Trajectory, separator: str) -> None:
    """Write a heading and a row for each instant, with the time first.

    Raises:
        OSError: Writing failed. No file is left behind.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole(path) as draft, draft.open("w", encoding="utf-8", newline="\n") as file:
        file.write(head)
        _write_rows(file, trajectory, separator)


def _write_rows(file: IO[str], trajectory: Trajectory, separator: str) -> None:
    for begin in range(0, trajectory.times.size, _BLOCK):
        block = slice(begin, begin + _BLOCK)
        file.writelines(_lines(trajectory, block, separator))


def _lines(trajectory: Trajectory, block: slice, separator: str) -> Iterator[str]:
    for time, row in zip(trajectory.times[block].tolist(), trajectory.values[block].tolist(), strict=True):
        yield separator.join(map(repr, [time, *row])) + "\n"
