"""Uneven ground in a film: a height field along the path, and level ground below what it leaves free."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.mechanics.ground import GROUND
from gaitsim.compiler.mechanics.places import Relief

_BEHIND = 3.0  # m of ground behind the world's origin
_FASTEST = 4.0  # m/s, of what the ground is long enough for
_LONGEST = 1500  # points along the path
_APART = 0.05  # m between points, if the path is not too long
_THICK = 0.01  # m of ground below the lowest point


def add_relief(spec: Any, relief: Relief, duration: float, near: float, far: float) -> None:
    """Show uneven ground.

    Args:
        spec: MuJoCo's mjSpec. Its ground is lowered so that it is below all hollows.
        relief: The heights.
        duration: How long the film is, in s.
        near: The right edge of the ground, in m to the left.
        far: The left edge.
    """
    length = _BEHIND + _BEHIND + _FASTEST * duration
    columns = min(_LONGEST, round(length / _APART) + 1)
    rows = round((far - near) / _APART) + 1
    forward, left = np.linspace(-_BEHIND, length - _BEHIND, columns), np.linspace(near, far, rows)
    heights = np.array([[relief.at(float(x), float(y))[0] for x in forward] for y in left])
    low, high = float(heights.min()), float(heights.max())
    spec.add_hfield(
        name="gaitsim.relief",
        nrow=rows,
        ncol=columns,
        size=[length / 2, (far - near) / 2, max(high - low, 1e-6), _THICK],
        userdata=heights.ravel(),
    )
    for geom in spec.geoms:
        if geom.name.startswith(GROUND):
            geom.pos = (geom.pos[0], geom.pos[1], low - _THICK)
    spec.worldbody.add_geom(
        name="gaitsim.relief",
        type=mujoco.mjtGeom.mjGEOM_HFIELD,
        hfieldname="gaitsim.relief",
        pos=[length / 2 - _BEHIND, (near + far) / 2, low],
        material="gaitsim.tiles",
        contype=0,
        conaffinity=0,
    )
