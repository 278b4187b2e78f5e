"""Tables of recorded curves in a library, such as library/norms/fukuchi2018_walking.csv.

Lines that begin with # describe the table, its source and its licence. They are followed by a row of names with units,
such as `knee_flexion [deg]`, and rows of numbers. The first column is the position in the cycle in %. Columns are
separated by commas, or by semicolons as in the spreadsheets of many languages; with semicolons, decimal commas are read
too.
"""

from __future__ import annotations

import csv
import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gaitsim.components.load import as_lines
from gaitsim.errors import Fault, Faults, InvalidSpec, Mark
from gaitsim.units import UnknownUnit, parse_unit

Floats = NDArray[np.float64]
Row = tuple[Mark, list[str]]
_NAME = re.compile(r"(\w+) \[(.+)\]")
_HOLE = 0.1  # share of the cycle; across larger gaps, linear interpolation is not a recorded curve
_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class Table:
    """Columns of numbers in SI over the first column, with the units of the file."""

    path: Path
    text: str
    about: str
    over: Floats
    columns: dict[str, Floats]
    units: dict[str, str]

    @property
    def recorded_by(self) -> str:
        """The key of the bibliography in its line `source:`."""
        lines = (line.partition(":") for line in self.about.splitlines())
        return next((rest.strip() for word, _, rest in lines if word == "source"), "")

    def curve(self, column: str, count: int) -> tuple[float, ...]:
        """A column, interpolated at `count` equal distances from 0 to 100 % of the cycle, in SI."""
        return resampled(self.over, self.columns[column], count)


def load_table(path: Path, display_path: str, text: str) -> Table:
    """Read a table.

    Args:
        path: The file.
        display_path: The name of the file in messages.
        text: The text of the file.

    Raises:
        InvalidSpec: Rows have faults; the error holds all of them.
    """
    text = as_lines(text)
    about, rows, separator = _split(text.removeprefix("\ufeff"), display_path)
    if len(rows) < 3:
        rule = "a table has a row of names with units, such as cycle [%],knee_flexion [deg], and two rows of numbers"
        raise InvalidSpec(Fault(f"{rule} or more.", Mark(display_path)))
    heads, faults = _columns(rows[0]), Faults()
    numbers = [list(_numbers(row, len(heads), separator != ",", faults)) for row in rows[1:]]
    faults.raise_if_any()
    over = parse_unit(heads[0][1]).factor * np.array([row[0] for row in numbers])
    _check_cycle(over, [mark for mark, _ in rows[1:]], heads[0][0], faults)
    faults.raise_if_any()
    table = np.array(numbers) * [parse_unit(unit).factor for _, unit in heads]
    columns = {name: table[:, i] for i, (name, _) in enumerate(heads) if i}
    return Table(path, text, "\n".join(about), table[:, 0], columns, dict(heads[1:]))


def resampled(over: Floats, values: Floats, count: int) -> tuple[float, ...]:
    """Interpolate a curve linearly at equal distances from 0 to 100 % of the cycle.

    A cycle begins again where it ends. Values before the first point and after the last are therefore interpolated
    between these two.

    Args:
        over: Increasing positions in the cycle, 0 to 1.
        values: One value for each.
        count: The number of values to return.
    """
    return tuple(float(v) for v in np.interp(np.linspace(0, 1, count), over, values, period=_period(over)))


def _period(over: Floats) -> float | None:
    """The period of the interpolation: None if the points reach from 0 to 1, where the two values may differ."""
    return None if over[0] <= 0 and over[-1] >= 1 else 1.0


def _split(text: str, display_path: str) -> tuple[list[str], list[Row], str]:
    """The description of a table, its rows as words, and the separator. Empty rows are skipped."""
    about, rows, separator = list[str](), list[Row](), ","
    for n, line in enumerate(text.splitlines(), start=1):
        if line.startswith("#"):
            about.append(line.lstrip("# "))
            continue
        if not rows:
            separator = next((letter for letter in ";\t" if letter in line), ",")
        cells = [word.strip() for word in next(csv.reader([line], delimiter=separator), [])]
        if any(cells):
            rows.append((Mark(display_path, n), cells))
    return about, rows, separator


def _columns(row: Row) -> list[tuple[str, str]]:
    """Names and units of all columns.

    Raises:
        InvalidSpec: The row of names has a fault.
    """
    place, cells = row
    faults, found = Faults(), []
    for word in cells:
        head = _NAME.fullmatch(word)
        if head is None:
            faults.add(f'"{word}" is not a name with a unit; write such as knee_flexion [deg].', place)
            continue
        try:
            found.append((head[1], parse_unit(head[2]).text))
        except UnknownUnit:
            faults.add(f'"{head[2]}" is not a known unit; write such as knee_flexion [deg].', place)
    faults.raise_if_any()
    if len(found) < 2:
        faults.add("there is one column; a curve needs another beside it.", place)
    for name, count in Counter(name for name, _ in found).items():
        if count > 1:
            faults.add(f"{count} columns are named {name}; give each a name of its own.", place)
    name, unit = found[0]
    if not parse_unit(unit).dimension.plain:
        rule = f"{name} is in {unit}; the first column says where in the cycle a row lies, as a share"
        faults.add(f"{rule}: write such as cycle [%], 0 to 100.", place)
    faults.raise_if_any()
    return found


def _check_cycle(over: Floats, marks: Sequence[Mark], name: str, faults: Faults) -> None:
    """Check that rows increase, lie within the cycle and cover it."""

    def percent(share: float) -> str:
        return f"{100 * share:.6g} %"

    for before, now, mark, place in zip(over, over[1:], marks, marks[1:], strict=False):
        if now == before:
            faults.add(f"{name} is {percent(now)}, as in line {mark.line}; keep one of the two rows.", place)
        elif now < before:
            faults.add(
                f"{name} is {percent(now)} after {percent(before)}; put the rows in order, one cycle only.", place
            )
        elif now - before > _HOLE + _ROUNDING:
            rule = f"no row lies between {percent(before)} and {percent(now)} of the cycle"
            faults.add(f"{rule}; add some, as a recorded curve has one each {percent(_HOLE)} or closer.", place)
    for share, place in zip(over, marks, strict=True):
        if not -_ROUNDING <= share <= 1 + _ROUNDING:
            faults.add(f"{name} is {percent(share)}, and a cycle goes from 0 to 100 %; check unit and rows.", place)
    closing, widest = over[0] + 1 - over[-1], float(np.max(np.diff(over)))
    if not faults.found and closing > widest + _ROUNDING:
        rule = f"the rows cover {percent(over[0])} to {percent(over[-1])} of the cycle, and a curve covers 0 to 100 %"
        faults.add(f"{rule}; add the rows that are missing. gaitsim does not extrapolate.", marks[-1])


def _numbers(row: Row, count: int, decimal_comma: bool, faults: Faults) -> Iterable[float]:
    """The numbers of a row. Each word that is not a number is a fault."""
    place, cells = row
    if len(cells) != count:
        faults.add(f"this row has {len(cells)} numbers, and there are {count} names.", place)
    for word in cells:
        try:
            value = float(word.replace(",", ".") if decimal_comma else word)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            rule = f'"{word}" is not a number' if word else "a number is missing"
            faults.add(f"{rule}; write such as 12.5, or remove the row.", place)
        yield value
