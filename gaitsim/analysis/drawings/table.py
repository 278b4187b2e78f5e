"""Tables of texts, and the format of numbers in them."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """Cells as text. Numeric columns are aligned to the right."""

    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numeric: frozenset[int] = frozenset()


def formatted(number: float | None, digits: int = 5) -> str:
    """A number as text for a table; a dash for nan."""
    if number is None or not math.isfinite(number):
        return "–"
    return f"{number:.{digits}g}".replace("-", "\N{MINUS SIGN}")
