"""The ground in MuJoCo: a plane through the origin of the world, or boxes side by side for steps."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

GROUND = "world.ground"
_FAR = 1000.0  # m: how far the first and the last tread reach
_THICK = 1.0  # m


def add_surface(spec: Any, name: str, angle: float, across: float, info: str) -> None:
    """Add a site for sloping ground. Its x axis points forwards along the ground, its z axis is the normal.

    Args:
        spec: MuJoCo's mjSpec.
        name: The name of the site.
        angle: The slope forwards, in rad.
        across: The slope to the left about the x axis, in rad.
        info: The place in the spec, for MuJoCo's messages.
    """
    spec.worldbody.add_site(name=name, quat=_tilt(angle, across), size=[0.005] * 3, info=info)


def add_ground(spec: Any, angle: float, across: float, edges: Sequence[tuple[float, float]], info: str) -> None:
    """Add the geoms that spheres of `Mechanics.collide` rest on. A second part may ask for the same ground.

    Raises:
        ValueError: There is another ground already.
    """
    # At an edge without a height, a sphere would touch two boxes and get twice the force.
    level = all(height == 0 for _, height in edges)
    wanted = [_plane(angle, across)] if level else _treads(angle, edges)
    present = [geom for geom in spec.worldbody.geoms if geom.name.startswith(GROUND)]
    if present:
        if not _same(present, wanted):
            raise ValueError("there is one ground, and another part has made a different one; give both one terrain")
        return
    for number, shape in enumerate(wanted):
        name = f"{GROUND}.{number}" if number else GROUND
        spec.worldbody.add_geom(name=name, contype=1, conaffinity=0, info=info, **shape)


def _plane(angle: float, across: float) -> dict[str, Any]:
    quat = _tilt(angle, across)
    return {"type": mujoco.mjtGeom.mjGEOM_PLANE, "size": [10, 10, 0.1], "pos": [0, 0, 0], "quat": quat}


def _treads(angle: float, edges: Sequence[tuple[float, float]]) -> list[dict[str, Any]]:
    """A box for each tread: at height 0 before the first edge, and at the given height behind each edge."""
    begins = [-_FAR, *(position for position, _ in edges)]
    ends = [*(position for position, _ in edges), _FAR]
    heights = [0.0, *(height for _, height in edges)]
    boxes = []
    for begin, end, height in zip(begins, ends, heights, strict=True):
        along, up = (begin + end) / 2, height - _THICK / 2
        x = along * math.cos(angle) - up * math.sin(angle)
        z = along * math.sin(angle) + up * math.cos(angle)
        size = [(end - begin) / 2, 10, _THICK / 2]
        boxes.append({"type": mujoco.mjtGeom.mjGEOM_BOX, "size": size, "pos": [x, 0, z], "quat": _tilt(angle)})
    return boxes


def _tilt(angle: float, across: float = 0.0) -> list[float]:
    # A positive rotation about y, which points to the left, lowers the front.
    forwards = [math.cos(angle / 2), 0.0, -math.sin(angle / 2), 0.0]
    if across == 0:
        return forwards
    both = np.zeros(4)
    mujoco.mju_mulQuat(both, np.array(forwards), np.array([math.cos(across / 2), math.sin(across / 2), 0.0, 0.0]))
    return [float(part) for part in both]


def _same(present: Sequence[Any], wanted: Sequence[dict[str, Any]]) -> bool:
    if len(present) != len(wanted):
        return False
    return all(
        geom.type == shape["type"] and all(list(getattr(geom, key)) == shape[key] for key in ("size", "pos", "quat"))
        for geom, shape in zip(present, wanted, strict=True)
    )
