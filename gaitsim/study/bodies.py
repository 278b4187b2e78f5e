"""Tables of bodies: CSV files with a row for each body and columns that are parameters of the spec."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from gaitsim.errors import Fault, Faults, InvalidSpec, Mark, Usage, did_you_mean
from gaitsim.model import Model
from gaitsim.spec.inheritance import override
from gaitsim.study.opened import Opened
from gaitsim.text.document import MappingNode
from gaitsim.text.quantity import BadQuantity, quantity_of
from gaitsim.units import UnknownUnit, parse_unit

_NAME = "name"
_BODY = {"height": "body_height", "mass": "body_mass", "sex": "female"}  # a column, and the parameter that it is
_SEXES = {"female": "1", "f": "1", "woman": "1", "male": "0", "m": "0", "man": "0"}
_SHIPPED = "specs/walking_geyer2010.yaml"
_HEADING = re.compile(r"(?P<word>[^\[\]]+?)\s*(\[(?P<unit>[^\[\]]*)\])?")
_DECIMAL_COMMA = re.compile(r"(?<![\d,.])([-+]?\d+),(\d+)(?![\d,.])")
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_SAMPLE = "name,height [m],mass [kg]"


@dataclass(frozen=True)
class Body:
    """One row of the table: the name, the settings of the spec as text by address, and the place."""

    name: str
    settings: dict[str, str]
    place: str


@dataclass(frozen=True)
class _Column:
    """One column: its heading, the address that it sets (empty for names), and the unit of its numbers if it has
    one.
    """

    heading: str
    address: str
    unit: str
    mark: Mark


def bodies_in(path: Path, opened: Opened, model: Model) -> list[Body]:
    """Read a table of bodies, and check it against the spec.

    Values that are invalid only for a single body, such as a mass of 0, are not checked here.

    Args:
        path: The table.
        opened: The spec.
        model: The model of the spec without changes.

    Raises:
        Usage: There is no such table.
        InvalidSpec: The table has faults; the error holds all of them.
    """
    lines = _lines(path)
    faults = Faults()
    (first, heading), *rows = lines
    columns = _columns(heading, Mark(str(path), first), faults)
    faults.raise_if_any()
    known = _known(columns, rows, path, opened, model, faults)
    bodies = []
    for number, (line, cells) in enumerate(rows, start=1):
        mark = Mark(str(path), line)
        if len(cells) != len(columns):
            rule = f"this row has {len(cells)} cells, and the first row names {len(columns)} columns"
            faults.add(f"{rule}; write one for each, and a number with a point, or columns separated by ;.", mark)
            continue
        bodies.append(_body(columns, cells, str(number), mark, known, faults))
    _check_names(bodies, faults)
    if not rows:
        faults.add("there is no body below the columns; write a row for each.", Mark(str(path)))
    faults.raise_if_any()
    return bodies


def _lines(path: Path) -> list[tuple[int, list[str]]]:
    """The rows that are not empty, with their line numbers.

    Raises:
        Usage: There is no such table.
        InvalidSpec: It is not a CSV text.
    """
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError as error:
        raise Usage(f"{path}: there is no such file; name a table of bodies with columns such as {_SAMPLE}.") from error
    except OSError as error:
        raise Usage(f"{path}: this cannot be read ({error.strerror or error}); name a table of bodies.") from error
    except UnicodeDecodeError as error:
        rule = "this is not a text in UTF-8; save it as CSV, in a spreadsheet as CSV UTF-8"
        raise InvalidSpec(Fault(f"{rule}.", Mark(str(path)))) from error
    heading = next((line for line in text.splitlines() if line.strip()), "")
    separator = next((sign for sign in (";", "\t") if sign in heading), ",")
    try:
        reader = csv.reader(text.splitlines(), delimiter=separator, strict=True)
        lines = [(reader.line_num, [cell.strip() for cell in cells]) for cells in reader]
    except csv.Error as error:
        rule = f"this is not a table of separated values ({error}); save it as CSV"
        raise InvalidSpec(Fault(f"{rule}.", Mark(str(path)))) from error
    found = [(number, cells) for number, cells in lines if any(cells)]
    if not found:
        raise InvalidSpec(Fault(f"this file is empty; write columns such as {_SAMPLE}, and rows.", Mark(str(path))))
    if separator == ",":
        return found
    return [(number, [_DECIMAL_COMMA.sub(r"\1.\2", cell) for cell in cells]) for number, cells in found]


def _columns(heading: Sequence[str], mark: Mark, faults: Faults) -> list[_Column]:
    """The columns by the first row of the table."""
    columns = []
    for cell in heading:
        match = _HEADING.fullmatch(cell)
        if match is None or _NUMBER.match(cell):
            rule = f'"{cell}" names no column' if cell else "this column has no name"
            faults.add(f"{rule}; the first row names them, such as {_SAMPLE}.", mark)
            continue
        word, unit = match["word"], (match["unit"] or "").strip()
        address = "" if word == _NAME else _BODY.get(word, word)
        columns.append(_Column(word, address, unit, mark))
        try:
            parse_unit(unit or "1")
        except UnknownUnit:
            rule = f"{unit} is not a unit that is known; write such as height [m], height [cm] or mass [kg]"
            faults.add(f"{rule}.", mark, word)
    for address, count in Counter(column.address for column in columns).items():
        if count > 1:
            headings = " and ".join(column.heading for column in columns if column.address == address)
            faults.add(f"{headings} are one column {count} times; leave one.", mark)
    if not any(column.address for column in columns) and not faults.found:
        faults.add(f"no column says what differs between bodies; write such as {_SAMPLE}.", mark)
    return columns


def _known(
    columns: Sequence[_Column],
    rows: Sequence[tuple[int, list[str]]],
    path: Path,
    opened: Opened,
    model: Model,
    faults: Faults,
) -> dict[str, str]:
    """The unit of each column that is a number of the spec. A column that the spec does not have is a fault."""
    numbers = {number.address: number.unit.text for number in model.numbers}
    found = {}
    for index, column in enumerate(columns):
        if not column.address:
            continue
        first, _, rest = column.address.partition(".")
        names = (column.address, f"{first}_l.{rest}", f"{first}_r.{rest}")
        unit = next((numbers[name] for name in names if name in numbers), None)
        if unit is not None:
            found[column.address] = unit
            cells = [cells[index] for _, cells in rows if index < len(cells)]
            if not column.unit and unit != "1" and any(_NUMBER.fullmatch(cell) for cell in cells):
                rule = "its numbers have no unit; write it in the first row"
                faults.add(
                    f"{rule}, such as {column.heading} [{unit}], or with each value.", column.mark, column.heading
                )
        elif column.heading in _BODY:
            faults.add(_undeclared(column), column.mark, column.heading)
        else:
            texts = [cells[index] for _, cells in rows if len(cells) == len(columns)]
            _try(column, texts[0] if texts else "1", path, opened, faults)
    return found


def _undeclared(column: _Column) -> str:
    """The message for a column of a body that the spec has no parameter for."""
    if column.heading == "sex":
        rule = "this spec has one body for both sexes, as it declares no parameter female"
        move = "leave the column out, or build the body of segments such as segment/thigh_deleva1996, female: =female"
        return f"{rule}; {move}."
    rule = f"this spec declares no parameter {column.address}, so no part of its body follows from it"
    return f"{rule}; declare it under parameters: and use it as {_SHIPPED} does, or leave the column out."


def _try(column: _Column, text: str, path: Path, opened: Opened, faults: Faults) -> None:
    """Check whether a column without numbers is another setting of the spec, such as a use:."""
    columns = ", ".join([_NAME, *_BODY])
    if "." not in column.address:
        parameters = opened.document.entries.get("parameters")
        own = parameters.entries if isinstance(parameters, MappingNode) else {}
        rule = f"neither a column of bodies ({columns}) nor a parameter of this spec"
        faults.add(f"{rule}. {did_you_mean(column.heading, [_NAME, *_BODY, *own])}", column.mark, column.heading)
        return
    try:
        opened.model(override(opened.document, column.address, text or "null", str(path)))
    except (InvalidSpec, Usage) as error:
        rule = " ".join(dict.fromkeys(fault.message for fault in error.faults))
        faults.add(f"no column of bodies ({columns}), and in the spec: {rule}", column.mark, column.heading)


def _body(
    columns: Sequence[_Column], cells: Sequence[str], number: str, mark: Mark, known: dict[str, str], faults: Faults
) -> Body:
    name, settings = number, {}
    for column, cell in zip(columns, cells, strict=True):
        if not column.address:
            name = cell or number
            continue
        if not cell:
            faults.add(f"there is no {column.heading}; write it, or leave the row out.", mark, column.heading)
            continue
        text = _SEXES.get(cell.lower(), cell) if column.heading == "sex" else cell
        if column.heading == "sex" and text not in ("0", "1"):
            faults.add(f'"{cell}" is neither female nor male; write one of them.', mark, column.heading)
            continue
        if _NUMBER.fullmatch(text) and column.unit:
            text = f"{text} {column.unit}"
        if column.address in known:
            try:
                quantity_of(text, known[column.address] if column.unit or not _NUMBER.fullmatch(text) else "1")
            except BadQuantity as error:
                faults.add(str(error), mark, column.heading)
        settings[column.address] = text
    return Body(name, settings, str(mark))


def _check_names(bodies: Sequence[Body], faults: Faults) -> None:
    for name, mine in _same(bodies):
        places = ", ".join(body.place for body in mine)
        faults.add(f"{len(mine)} bodies are called {name} ({places}); give each its own name.", Mark(mine[0].place))


def _same(bodies: Sequence[Body]) -> Iterator[tuple[str, list[Body]]]:
    """Names of more than one body, with these bodies."""
    for name, count in Counter(body.name for body in bodies).items():
        if count > 1:
            yield name, [body for body in bodies if body.name == name]
