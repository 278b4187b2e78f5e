"""Drawings beside the bodies: massless limbs as lines, forces as arrows, activation as colour."""

from __future__ import annotations

import itertools
from typing import Any

import mujoco
import numpy as np

from gaitsim.animation import colours
from gaitsim.animation.camera import Views
from gaitsim.animation.posture import Floats, Posture

_ARROW = 0.012  # of half the height of what is seen: half the width of a shaft
_HALVED = 2.0  # MuJoCo draws arrows with half the given length
_LEAST = 0.005  # of a metre: shorter arrows are left out


def paint_muscles(posture: Posture) -> None:
    """Colour the path of each muscle by its activation."""
    for tendon, signal in posture.stage.muscles:
        posture.stage.mechanics.tendon_rgba[tendon] = (*colours.of_activation(posture.signal(signal)), 1)


def add(scene: Any, posture: Posture, views: Views) -> None:
    """Add lines, and arrows in the scale of these views, to a scene of MuJoCo."""
    width = _ARROW * views.half_height
    for line in posture.stage.lines:
        places = [posture.place(spot) for spot in line.spots]
        for start, end in itertools.pairwise(places):
            _connect(scene, mujoco.mjtGeom.mjGEOM_CAPSULE, line.radius, start, end, colours.LIMB)
    for force in posture.stage.forces:
        along = posture.force(force) / views.newtons
        if np.linalg.norm(along) > _LEAST:
            place = posture.place(force.spot)
            # In front of the limb, which would hide it otherwise.
            place = place - 0.12 * views.away
            _connect(scene, mujoco.mjtGeom.mjGEOM_ARROW, width, place, place + _HALVED * along, colours.FORCE)


def _connect(scene: Any, kind: Any, width: float, start: Floats, end: Floats, colour: tuple[float, ...]) -> None:
    if scene.ngeom >= scene.maxgeom:
        return
    geom = scene.geoms[scene.ngeom]
    rgba = np.array([*colour, 1], dtype=np.float32)
    mujoco.mjv_initGeom(geom, kind.value, np.zeros(3), np.zeros(3), np.eye(3).ravel(), rgba)
    mujoco.mjv_connector(geom, kind.value, width, start, end)
    scene.ngeom += 1
