"""Comparison of curves over the gait cycle with the tables of healthy people in library/norms/.

A curve has 101 points, from 0 to 100 % of a stride from touchdown to touchdown, in SI.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gaitsim.components.find import Library
from gaitsim.units import parse_unit

Floats = NDArray[np.float64]

POINTS = 101
WALKING = "norms/fukuchi2018_walking"
RUNNING = "norms/fukuchi2017_running"
_LEAST_WIDTH = 0.01  # least width of a band, in the unit of its table


@dataclass(frozen=True)
class Norm:
    """A curve of people in SI: mean and standard deviation over subjects. The deviation may be unknown."""

    name: str
    unit: str
    mean: Floats
    deviation: Floats | None
    recorded_by: str

    @property
    def band(self) -> tuple[Floats, Floats]:
        """One standard deviation below and above the mean; the mean itself if the deviation is unknown."""
        width = np.zeros(POINTS) if self.deviation is None else self.deviation
        return self.mean - width, self.mean + width


@dataclass(frozen=True)
class Comparison:
    """The comparison of a curve with a norm. Values are in SI, positions in the cycle from 0 to 1."""

    reach: float
    norm_reach: float
    highest_at: float
    norm_highest_at: float
    lowest_at: float
    norm_lowest_at: float
    error: float
    shape_error: float
    correlation: float
    fit: float
    shape_fit: float


def read_norm(column: str, library: Library, table: str = WALKING) -> Norm:
    """Read a column of a table of norms, and its column `_sd` if there is one.

    Args:
        column: The name of the column.
        library: The tables.
        table: The name of the table.

    Raises:
        InvalidSpec: There is no such table.
        KeyError: It has no such column.
    """
    found = library.table(table)
    mean = np.array(found.curve(column, POINTS))
    spread = f"{column}_sd"
    deviation = np.array(found.curve(spread, POINTS)) if spread in found.columns else None
    return Norm(f"{table}.{column}", found.units[column], mean, deviation, found.recorded_by)


def strides(times: Floats, values: Floats, touchdowns: Sequence[float]) -> Floats:
    """A signal over the strides between touchdowns.

    Args:
        times: In s.
        values: The signal.
        touchdowns: Times in s, in order. A stride that the signal does not cover is left out.

    Returns:
        An array of strides x 101 points.
    """
    begun = [(begin, end) for begin, end in pairwise(touchdowns) if times[0] <= begin and end <= times[-1]]
    rows = [np.interp(np.linspace(begin, end, POINTS), times, values) for begin, end in begun]
    return np.array(rows, dtype=np.float64).reshape(-1, POINTS)


def root_mean_square_error(curve: Floats, mean: Floats) -> float:
    """The root-mean-square difference, in the unit of the curves."""
    return float(np.sqrt(np.mean((curve - mean) ** 2)))


def correlation(curve: Floats, mean: Floats) -> float:
    """Pearson's correlation; nan if one of the curves is constant."""
    if np.ptp(curve) == 0 or np.ptp(mean) == 0:
        return float("nan")
    return float(np.corrcoef(curve, mean)[0, 1])


def fit_percentage(curve: Floats, low: Floats, high: Floats, least_width: float) -> float:
    """100 (1 - mean excess outside the band / width of the band), from 0 to 100, as SCONE reports it.

    The excess at each point is divided by the width there, or by `least_width` if that is larger.
    """
    excess = np.maximum(0, np.maximum(low - curve, curve - high))
    share = float(np.mean(excess / np.maximum(high - low, least_width)))
    return 100 * min(1.0, max(0.0, 1 - share))


def compared(curve: Floats, norm: Norm) -> Comparison:
    """Compare a curve of 101 points with a norm.

    The zeros of hip and ankle angles differ by 10 to 20 deg between laboratories. `shape_error` and `shape_fit`
    therefore compare the curve after it was shifted to the mean of the norm.
    """
    low, high = norm.band
    least = _LEAST_WIDTH * parse_unit(norm.unit).factor
    moved = curve - np.mean(curve) + np.mean(norm.mean)
    return Comparison(
        reach=float(np.ptp(curve)),
        norm_reach=float(np.ptp(norm.mean)),
        highest_at=_place(int(np.argmax(curve))),
        norm_highest_at=_place(int(np.argmax(norm.mean))),
        lowest_at=_place(int(np.argmin(curve))),
        norm_lowest_at=_place(int(np.argmin(norm.mean))),
        error=root_mean_square_error(curve, norm.mean),
        shape_error=root_mean_square_error(moved, norm.mean),
        correlation=correlation(curve, norm.mean),
        fit=fit_percentage(curve, low, high, least),
        shape_fit=fit_percentage(moved, low, high, least),
    )


def _place(index: int) -> float:
    return index / (POINTS - 1)
