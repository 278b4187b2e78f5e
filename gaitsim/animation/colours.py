"""Colours of muscle activation and of forces."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

FORCE = (0.10, 0.55, 0.25)
LIMB = (0.45, 0.42, 0.40)  # of lines that stand for massless segments
_RESTING = np.array([0.16, 0.30, 0.72])
_HALF = np.array([0.62, 0.30, 0.62])
_ACTIVE = np.array([0.90, 0.07, 0.07])


def of_activation(level: float) -> NDArray[np.float64]:
    """The colour of an activation, as red, green and blue from 0 to 1: blue at rest, red at full activation."""
    share = 2 * min(1.0, max(0.0, level))
    if share < 1:
        return np.asarray((1 - share) * _RESTING + share * _HALF)
    return np.asarray((2 - share) * _HALF + (share - 1) * _ACTIVE)


@cache
def scale(count: int) -> NDArray[np.uint8]:
    """The colours of activations from 0 to 1: an array of count x 3 values from 0 to 255."""
    return np.round([255 * of_activation(level) for level in np.linspace(0, 1, count)]).astype(np.uint8)
