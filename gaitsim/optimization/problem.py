"""The problem of a search: named numbers with bounds, a start and a spread."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gaitsim.units import Unit

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Variable:
    """One tuned number, in SI.

    Attributes:
        unit: The unit in which it is shown.
    """

    address: str
    unit: Unit
    low: float
    high: float
    start: float
    spread: float


@dataclass(frozen=True)
class Problem:
    """The tuned numbers. Algorithms use their values divided by their spreads."""

    variables: tuple[Variable, ...]

    @property
    def start(self) -> list[float]:
        return [variable.start for variable in self.variables]

    # Algorithms use values divided by their spreads, so that forces and angles change at the same rate.
    def scaled(self, values: Sequence[float]) -> Vector:
        return np.asarray(values, dtype=np.float64) / self._spreads

    def values(self, scaled: Vector) -> list[float]:
        """The values in SI of a scaled vector, exactly within their bounds."""
        low, high = self.bounds
        return [float(v) for v in np.clip(scaled * self._spreads, low, high)]

    @property
    def bounds(self) -> tuple[Vector, Vector]:
        low = np.array([variable.low for variable in self.variables])
        high = np.array([variable.high for variable in self.variables])
        return low, high

    @property
    def _spreads(self) -> Vector:
        return np.array([variable.spread for variable in self.variables])


def hash_of(values: Sequence[float]) -> str:
    """A short digest of a vector's bits, which shows whether a replay asks for another vector."""
    return hashlib.sha256(np.asarray(values, dtype="<f8").tobytes()).hexdigest()[:16]
