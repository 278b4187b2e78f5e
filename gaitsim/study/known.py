"""Known values that a model should reproduce, compared with its record."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from gaitsim.model import KnownValue
from gaitsim.study.records import Value
from gaitsim.units import parse_unit


@dataclass(frozen=True)
class Compared:
    """A known value and that of the model as recorded, both in `unit`.

    Attributes:
        model: The model's value; None if the record has none.
        tolerance: The largest difference that counts as equal; None if the spec gives none.
    """

    what: str
    metric: str
    known: float
    model: float | None
    unit: str
    tolerance: float | None
    source: str

    @property
    def difference(self) -> float | None:
        """The model's value minus the known one."""
        return None if self.model is None else self.model - self.known

    @property
    def share(self) -> float | None:
        """The difference relative to the known value; None if that is 0."""
        return None if self.difference is None or not self.known else self.difference / abs(self.known)

    @property
    def holds(self) -> bool | None:
        """Whether the difference is within the tolerance; None without a tolerance."""
        if self.difference is None or self.tolerance is None:
            return None
        return abs(self.difference) <= self.tolerance


def compared(rows: Iterable[KnownValue], recorded: Mapping[str, Value]) -> tuple[Compared, ...]:
    """Compare each known value with the recorded metric."""
    return tuple(_compared(row, recorded.get(row.metric)) for row in rows)


def _compared(row: KnownValue, found: Value | None) -> Compared:
    unit = parse_unit(row.unit)
    model = None if found is None or found.value is None else unit.of(found.value * parse_unit(found.unit).factor)
    tolerance = None if row.tolerance is None else unit.of(row.tolerance)
    return Compared(row.what, row.metric, unit.of(row.value), model, row.unit, tolerance, row.source)


def summary(rows: Iterable[Compared]) -> str:
    """A short summary: how many values hold, and the largest difference; empty without rows."""
    found = list(rows)
    judged = [row.holds for row in found if row.holds is not None]
    shares = [abs(row.share) for row in found if row.share is not None]
    texts = [f"{sum(judged)} of {len(judged)} within tolerance"] if judged else []
    texts += [f"differs by up to {100 * max(shares):.2g} %"] if shares else []
    return ", ".join(texts)
