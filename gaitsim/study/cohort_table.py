"""The table of a cohort: bodies, devices, how each row ended, and its metrics."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from gaitsim.model import Model, headed
from gaitsim.results.cohort import Row
from gaitsim.results.store import CannotSave
from gaitsim.simulation.outcome import Outcome
from gaitsim.units import UnknownUnit, parse_quantity, parse_unit
from gaitsim.whole import write_whole

Cell = str | float | int


class RowEnding(Protocol):
    """A row after its run."""

    @property
    def outcome(self) -> Outcome: ...

    @property
    def ending(self) -> str: ...

    @property
    def evaluations(self) -> int: ...


@dataclass(frozen=True)
class Cells:
    """Headings with units and their cells; nan where there is no number."""

    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]


def cells_of(model: Model, rows: Sequence[tuple[Row, RowEnding]]) -> Cells:
    """Make the table of rows.

    Args:
        model: The model of the spec without changes; numbers are in its units.
        rows: The rows and their results.
    """
    addresses = list(dict.fromkeys(address for row, _ in rows for address in row.settings))
    columns = {
        address: _column(address, [row.settings.get(address, "") for row, _ in rows], model) for address in addresses
    }
    metrics = list(model.metrics)
    heading = ["body", *(columns[address][0] for address in addresses)]
    heading += ["ending", "time [s]", "evaluations", "reason", "score", *(headed(name, [model]) for name in metrics)]
    cells = []
    for i, (row, found) in enumerate(rows):
        outcome = found.outcome
        score = math.nan if outcome.score is None else outcome.score
        numbers = [outcome.metrics.get(name, math.nan) for name in metrics]
        own = [columns[address][1][i] for address in addresses]
        seconds = round(outcome.simulated_seconds, 12)
        ended = (found.ending, seconds, found.evaluations, outcome.reason)
        cells.append((row.body, *own, *ended, score, *numbers))
    return Cells(tuple(heading), tuple(cells))


def write_cells(path: Path, cells: Cells) -> None:
    """Write the table as CSV, with empty cells where there is no number.

    Raises:
        CannotSave: The file cannot be written.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(cells.columns)
    for row in cells.rows:
        writer.writerow(["" if isinstance(cell, float) and math.isnan(cell) else cell for cell in row])
    try:
        write_whole(path, text.getvalue())
    except OSError as error:
        raise CannotSave(f"{path}: the table cannot be written ({error.strerror or error}).") from error


def _column(address: str, texts: Sequence[str], model: Model) -> tuple[str, list[Cell]]:
    """A heading with a unit and the numbers in it; cells that are not numbers are unchanged."""
    try:
        quantities = [parse_quantity(text) for text in texts]
    except UnknownUnit:
        quantities = [None]
    known = [quantity for quantity in quantities if quantity is not None]
    if len(known) < len(texts):
        return address, list(texts)
    first, _, rest = address.partition(".")
    numbers = {number.address: number.unit for number in model.numbers}
    names = (address, f"{first}_l.{rest}", f"{first}_r.{rest}", f"initial.{address}")
    unit = next((numbers[name] for name in names if name in numbers), known[0].unit)
    if any(quantity.unit.dimension.without_angle != unit.dimension.without_angle for quantity in known):
        return address, list(texts)
    heading = address if unit.text == "1" else f"{address} [{unit.text}]"
    return heading, [parse_unit(unit.text).of(quantity.value) for quantity in known]
