"""Tables of texts, and how numbers stand in them."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """Cells as text; numeric columns are set flush right."""

    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numeric: frozenset[int] = frozenset()


def shown(number: float | None, digits: int = 5) -> str:
    """A number as a table has it; a dash for none."""
    if number is None or not math.isfinite(number):
        return "–"
    return f"{number:.{digits}g}".replace("-", "\N{MINUS SIGN}")
