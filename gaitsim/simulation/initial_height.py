"""Initial poses that stand: the lowest contact is put on the ground."""

from __future__ import annotations

import math
from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.mechanics.ground import GROUND
from gaitsim.compiler.mechanics.places import Relief, Touching
from gaitsim.errors import SimulationFailed

_ABOVE = 100.0  # m: the height from which the ground is searched downwards


def stand(model: Any, data: Any, lift: int, touching: tuple[Touching, ...], relief: Relief | None = None) -> None:
    """Move a vertical coordinate until the lowest of some places touches the ground.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data.
        lift: The index of the coordinate.
        touching: The places.
        relief: The height of uneven ground; None if MuJoCo's model has the ground itself.

    Raises:
        SimulationFailed: There is no place, or no ground below one.
    """
    gaps = heights(model, data, touching, relief)
    if not gaps or not np.all(np.isfinite(gaps)):
        rule = "the initial pose cannot be placed on the ground: no part of it touches the ground"
        raise SimulationFailed(f"{rule}; add a contact, or set the height in initial:")
    data.qpos[lift] -= min(gaps)


def heights(model: Any, data: Any, touching: tuple[Touching, ...], relief: Relief | None = None) -> list[float]:
    """The heights of places above the ground in m; nan without ground below. Arguments are those of `stand`."""
    mujoco.mj_kinematics(model, data)
    return [_gap(model, data, place, relief) for place in touching]


def _gap(model: Any, data: Any, place: Touching, relief: Relief | None) -> float:
    """The distance of a place from the ground below it, in m."""
    body = model.body(place.body).id
    center = data.xpos[body] + data.xmat[body].reshape(3, 3) @ np.array(place.position)
    if relief is not None:
        height, *rises = relief.at(float(center[0]), float(center[1]))
        return float(center[2] - height - place.radius * math.hypot(1.0, *rises))
    up = np.array([0.0, 0.0, 1.0])
    above, down = center + _ABOVE * up, -up
    gaps = []
    for g in (g for g in range(model.ngeom) if model.geom(g).name.startswith(GROUND)):
        turn = data.geom_xmat[g]
        depth = mujoco.mju_rayGeom(data.geom_xpos[g], turn, model.geom_size[g], above, down, model.geom_type[g])
        if depth >= 0:
            # On a slope, a sphere touches the ground beside its lowest point: r / cos, not r.
            gaps.append(depth - _ABOVE - place.radius / turn[8])
    return float(min(gaps)) if gaps else float("nan")
