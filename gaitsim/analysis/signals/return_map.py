"""Return maps: the maxima of a signal, and the fixed point of the map from one to the next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
PROMINENCE = 0.05  # share of the signal's range; smaller rises are not events
_SETTLED = 1e-3  # of the events' size
_CLEAR = 5e-5  # relative to the events; a maximum is known to within one step only


@dataclass(frozen=True)
class FixedPoint:
    """A value that returns to itself, and the slope of the map there. It is stable if the slope is below 1 in
    magnitude.

    Attributes:
        slope: None if the events are too close to the value to estimate it.
    """

    value: float
    slope: float | None


def maxima(values: Floats, prominence: float = PROMINENCE) -> NDArray[np.int64]:
    """The indices of the local maxima that rise above their surroundings.

    Args:
        values: The signal.
        prominence: The smallest rise, as a fraction of the signal's range. The first and the last instant do not count,
            because their other side is unknown.
    """
    if values.size < 3 or not np.isfinite(values).all():
        return np.zeros(0, dtype=np.int64)
    least = prominence * float(np.ptp(values))
    if least == 0:
        return np.zeros(0, dtype=np.int64)
    found: list[int] = []
    high = low = 0
    rising = False
    for place in _turns(values):
        if values[place] > values[high]:
            high = place
        if values[place] < values[low]:
            low = place
        if rising and values[high] - values[place] > least:
            found.append(high)
            rising, low = False, place
        elif not rising and values[place] - values[low] > least:
            rising, high = True, place
    return np.array([place for place in found if place > 0], dtype=np.int64)


def at_passages(values: Floats, guard: Floats) -> Floats:
    """The values of a signal where a guard rises through 0, between instants by the straight line.

    Args:
        values: The signal.
        guard: The guard, which is compared at the same instants.
    """
    at = np.flatnonzero((guard[:-1] < 0) & (guard[1:] >= 0))
    share = guard[at] / (guard[at] - guard[at + 1])
    return values[at] + share * (values[at + 1] - values[at])


def _turns(values: Floats) -> list[int]:
    """The indices at which a signal turns, and its ends; a search for extremes needs no others."""
    steps = np.sign(np.diff(values))
    moving = np.flatnonzero(steps)
    if not moving.size:
        return [0]
    turning = moving[:-1][np.diff(steps[moving]) != 0] + 1
    return [0, *turning.tolist(), values.size - 1]


def fixed_point(events: Floats) -> FixedPoint | None:
    """The fixed point of the map from one event to the next; None if the events do not show one.

    If the events converge, it is their limit, and the slope is that of the last steps towards it. Otherwise it lies
    between two neighbouring points of the map on different sides of the diagonal.
    """
    if events.size < 3:
        return None
    now, after = events[:-1], events[1:]
    scale = max(float(np.abs(events).max()), 1e-12)
    last = float(after[-1] - now[-1])
    if abs(last) < _SETTLED * scale:
        slope = _approach(events, scale)
        # Aitken's extrapolation: the remaining change if the steps continue to shrink at the same rate.
        rest = last * slope / (1 - slope) if slope is not None and abs(slope) < 1 else 0.0
        return FixedPoint(float(after[-1]) + rest, slope)
    order = np.argsort(now)
    x, above = now[order], (after - now)[order]
    crossing = np.flatnonzero((above[:-1] > 0) & (above[1:] <= 0) | (above[:-1] < 0) & (above[1:] >= 0))
    crossing = crossing[np.diff(x)[crossing] > 0]
    if not crossing.size:
        return None
    return fixed_between(x, above, int(crossing[0]))


def fixed_between(x: Floats, above: Floats, i: int) -> FixedPoint:
    """The intersection of the line through points i and i + 1 of a map with the diagonal.

    Args:
        x: The abscissas.
        above: The heights above the diagonal.
        i: The index of the first point.
    """
    rise = float((above[i + 1] - above[i]) / (x[i + 1] - x[i]))
    return FixedPoint(float(x[i] - above[i] / rise), 1 + rise)


def _approach(events: Floats, scale: float) -> float | None:
    """The factor by which a step shrinks from one event to the next, from the last steps that are well resolved."""
    steps = np.diff(events)
    clear = np.abs(steps) > _CLEAR * scale
    usable = np.flatnonzero(clear[:-1] & clear[1:])[-2:]
    if not usable.size:
        return None
    before, behind = steps[usable], steps[usable + 1]
    return float(np.dot(before, behind) / np.dot(before, before))
