"""Tables of recorded curves beside the components: library/norms/fukuchi2018_walking.csv and their like.

Lines that begin with # say what it is, its source and its licence. Then come a row of names with
units, such as `knee_flexion [deg]`, and rows of numbers; the first column says where each row lies.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gaitsim.errors import Fault, InvalidSpec, Mark
from gaitsim.parts.load import as_lines
from gaitsim.spec.document import text_of
from gaitsim.units import UnknownUnit, parse_unit

Floats = NDArray[np.float64]
_NAME = re.compile(r"(\w+) \[(.+)\]")


@dataclass(frozen=True, eq=False)
class Table:
    """Columns of numbers in SI over those of the first, each with the unit that its file has."""

    path: Path
    source: str
    about: str
    over: Floats
    columns: dict[str, Floats]
    units: dict[str, str]

    @property
    def recorded_by(self) -> str:
        """What its line `source:` says: a key of the bibliography."""
        lines = (line.partition(":") for line in self.about.splitlines())
        return next((rest.strip() for word, _, rest in lines if word == "source"), "")


def load_table(path: Path, shown: str) -> Table:
    """Read a table. Errors: InvalidSpec with the line."""
    text = as_lines(text_of(path, shown, "table"))
    lines = text.splitlines()
    about = [line.lstrip("# ") for line in lines if line.startswith("#")]
    rows = [(n, line) for n, line in enumerate(lines, start=1) if line.strip() and not line.startswith("#")]
    names = [_name(word, Mark(shown, rows[0][0])) for word in next(csv.reader([rows[0][1]]))] if rows else []
    if len(names) < 2 or len(rows) < 3:
        rule = "a table has a row of names with units, such as cycle [%],knee_flexion [deg], and two rows of numbers"
        raise InvalidSpec(Fault(f"{rule} or more.", Mark(shown)))
    numbers = np.array([list(_numbers(line, len(names), Mark(shown, n))) for n, line in rows[1:]])
    if not np.all(np.diff(numbers[:, 0]) > 0):
        raise InvalidSpec(Fault(f"the first column, {names[0][0]}, must grow from row to row.", Mark(shown)))
    numbers *= [parse_unit(unit).factor for _, unit in names]
    columns = {name: numbers[:, i] for i, (name, _) in enumerate(names) if i}
    return Table(path, text, "\n".join(about), numbers[:, 0], columns, dict(names[1:]))


def resampled(over: Floats, values: Floats, count: int) -> tuple[float, ...]:
    """A curve at `count` equal distances from its first place to its last, straight between its points."""
    return tuple(float(v) for v in np.interp(np.linspace(over[0], over[-1], count), over, values))


def _name(word: str, mark: Mark) -> tuple[str, str]:
    found = _NAME.fullmatch(word.strip())
    if found is None:
        raise InvalidSpec(Fault(f'"{word}" is no name with a unit; write such as knee_flexion [deg].', mark))
    try:
        return found[1], parse_unit(found[2]).text
    except UnknownUnit as error:
        raise InvalidSpec(Fault(f'"{found[2]}" is no known unit; write such as knee_flexion [deg].', mark)) from error


def _numbers(line: str, count: int, mark: Mark) -> Iterable[float]:
    words = next(csv.reader([line]))
    if len(words) != count:
        raise InvalidSpec(Fault(f"this row has {len(words)} numbers, and there are {count} names.", mark))
    for word in words:
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InvalidSpec(Fault(f'"{word}" is no number.', mark))
        yield value
