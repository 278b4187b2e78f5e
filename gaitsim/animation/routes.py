"""Where to draw a path that is declared by moment arms: as a tendon beside the hinges that it turns.

A line that pulls a body towards the one that carries it increases the hinge's coordinate if it passes at arm * (u x a)
from the hinge, where a is the axis of the hinge and u points from it along the carrying body. How far a path extends
along its bodies is only a matter of appearance.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from gaitsim.animation.arms import Arm, ArmPath

Vector = NDArray[np.float64]
_NOTHING = 1e-3  # m
_ROUND = 0.95  # share of the arm: the radius around which a path wraps; an insertion at the arm must be outside
_BEYOND = 1.5  # arms: how far along a body that goes on straight the insertion is
_LEAST = 1.2  # arms: how far along the carrying body the origin is at least
_BESIDE = 0.4  # arms: how far the origin is from the line of its body
_OUTSIDE = 0.8  # arms: how far to the outer side, where limbs do not hide a path
_MASSLESS = {"mass": 0, "contype": 0, "conaffinity": 0}
_UNSEEN = (0, 0, 0, 0)


@dataclass(frozen=True)
class _Hinge:
    """A hinge in the neutral posture, and how a path passes it. Lengths are in m, in the world.

    Attributes:
        upwards, onwards: Unit vectors along the carrying and the carried body; zero without a direction.
        reach: The distance to the center of the carrying body.
        beside: The distance of the path from the axis.
        outside: The offset along the axis.
    """

    carrier: int
    carried: int
    anchor: Vector
    axis: Vector
    upwards: Vector
    onwards: Vector
    reach: float
    beside: Vector
    outside: Vector
    arm: float

    @property
    def drawable(self) -> bool:
        """Whether it joins two bodies along which a path can run."""
        return self.carrier != 0 and bool(self.upwards.any() and self.onwards.any())

    @property
    def passing(self) -> Vector:
        """Where a path passes it."""
        return self.anchor + self.beside + self.outside

    @property
    def insertion(self) -> Vector:
        """The end on the carried body: beside the hinge if the body points that way, as a foot does, else further
        along the body.
        """
        along = float(self.beside @ self.onwards)
        off = float(np.linalg.norm(self.beside - along * self.onwards))
        return self.anchor + self.outside + (along + _BEYOND * off) * self.onwards


class Drawer:
    """Adds tendons to the model of a film."""

    def __init__(self, spec: Any, mechanics: Any) -> None:
        """Prepare drawing.

        Args:
            spec: MuJoCo's mjSpec to draw into.
            mechanics: How the model was compiled before.
        """
        self.spec, self.mechanics, self.data = spec, mechanics, mujoco.MjData(mechanics)
        mujoco.mj_kinematics(mechanics, self.data)

    def draw(self, path: ArmPath) -> bool:
        """Draw a path from the first body to the last.

        Returns:
            Whether it was drawn; not if a hinge is on the ground, or if no chain joins the bodies.
        """
        hinges = sorted((self._hinge(arm, path.mirrored) for arm in path.arms), key=lambda hinge: hinge.carried)
        chained = all(upper.carried == lower.carrier for upper, lower in pairwise(hinges))
        if not (chained and all(hinge.drawable for hinge in hinges)):
            return False
        tendon = self.spec.add_tendon(name=path.address)
        self._site(tendon, "origin", hinges[0].carrier, _origin(hinges[0], hinges[-1].insertion, path.arms[0].length))
        for number, hinge in enumerate(hinges):
            if number:
                self._site(tendon, f"middle.{number}", hinge.carrier, (hinges[number - 1].passing + hinge.passing) / 2)
            self._bend(tendon, f"bend.{number}", hinge)
        self._site(tendon, "insertion", hinges[-1].carried, hinges[-1].insertion)
        return True

    def _hinge(self, arm: Arm, mirrored: bool) -> _Hinge:
        joint = self.mechanics.joint(arm.joint)
        carried = int(joint.bodyid[0])
        carrier = int(self.mechanics.body_parentid[carried])
        anchor, axis = self.data.xanchor[joint.id].copy(), self.data.xaxis[joint.id].copy()
        upwards, reach = _across(self.data.xipos[carrier] - anchor, axis)
        onwards, _ = _across(self.data.xipos[carried] - anchor, axis)
        beside = arm.arm * np.cross(upwards, axis)
        outside = _OUTSIDE * abs(arm.arm) * np.sign(axis[1]) * axis * (1 if mirrored else -1)  # y is to the left
        return _Hinge(carrier, carried, anchor, axis, upwards, onwards, reach, beside, outside, abs(arm.arm))

    def _site(self, tendon: Any, name: str, body: int, place: Vector) -> None:
        self._add_site(f"{tendon.name}.{name}", body, place)
        tendon.wrap_site(f"{tendon.name}.{name}")

    def _bend(self, tendon: Any, name: str, hinge: _Hinge) -> None:
        """Let the path wrap around the hinge at the moment arm."""
        turn = np.zeros(4)
        mujoco.mju_quatZ2Vec(turn, self._turned(hinge.carrier, hinge.axis))
        name, side = f"{tendon.name}.{name}", f"{tendon.name}.{name}.side"
        self._body(hinge.carrier).add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            pos=self._within(hinge.carrier, hinge.anchor),
            quat=turn,
            size=[_ROUND * hinge.arm, _ROUND * hinge.arm, 0],
            rgba=_UNSEEN,
            **_MASSLESS,
        )
        self._add_site(side, hinge.carrier, hinge.anchor + 2 * hinge.beside)
        tendon.wrap_geom(name, side)

    def _add_site(self, name: str, body: int, place: Vector) -> None:
        self._body(body).add_site(name=name, pos=self._within(body, place))

    def _body(self, number: int) -> Any:
        return self.spec.body(self.mechanics.body(number).name)

    def _within(self, body: int, place: Vector) -> Vector:
        """A point of the world in a body's frame."""
        return self._turned(body, place - self.data.xpos[body])

    def _turned(self, body: int, way: Vector) -> Vector:
        """A direction of the world in a body's frame."""
        return np.asarray(self.data.xmat[body].reshape(3, 3).T @ way)


def _origin(hinge: _Hinge, insertion: Vector, length: float) -> Vector:
    """The upper end of the path: about the length of the muscle above the hinge, limited by the length of the body."""
    below = float(np.linalg.norm(insertion - hinge.anchor))
    up = max(_LEAST * hinge.arm, min(hinge.reach, length - below))
    return hinge.anchor + hinge.outside + up * hinge.upwards + _BESIDE * hinge.beside


def _across(way: Vector, axis: Vector) -> tuple[Vector, float]:
    """The component of a vector perpendicular to an axis: its direction, or zeros, and its length."""
    across = way - (way @ axis) * axis
    length = float(np.linalg.norm(across))
    return (across / length, length) if length > _NOTHING else (np.zeros(3), 0.0)
