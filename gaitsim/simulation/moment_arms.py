"""Moment arms of paths about hinges. Each hinge alone is turned from the initial pose."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.mjcf import tie_place
from gaitsim.compiler.program import Floats, Program
from gaitsim.model import Model, Part
from gaitsim.simulation.crossings import crossings
from gaitsim.simulation.physics import Physics

_FREE = np.radians(150.0)  # to either side, of a hinge that declares no limits
_POINTS = 601
_SMOOTH = 10  # a declared moment arm is evaluated at every so many points
_TURN = 1e-6  # rad, for the derivative
_SAGITTAL = 0.9  # component of a unit axis to the left, within 26 deg of that direction
_NOTHING = 1e-6  # m; a smaller arm has no sign


@dataclass(frozen=True)
class MomentArm:
    """The moment arm of one path about one hinge. It is positive where tension increases the angle of the hinge.

    Attributes:
        muscle: The address of the muscle, or of the path if it belongs to no muscle.
        path: The component with the moment arm.
        points: Whether the path runs through points.
        limited: Whether the hinge declares its range.
        backwards: Whether a hanging child turns backwards as the angle increases, about the axis to the left; None if
            it turns out of the sagittal plane.
        alone: Whether the hinge is a whole joint; otherwise the arm also depends on the joint's other angles.
        initial: The moment arm in the initial pose, in m. Angles are in rad, arms and lengths in m.
    """

    muscle: str
    path: Part
    hinge: Part
    points: bool
    limited: bool
    backwards: bool | None
    alone: bool
    initial: float
    angles: Floats
    arms: Floats
    lengths: Floats

    @cached_property
    def turns(self) -> tuple[float, ...]:
        """The angles in rad at which the moment arm changes its sign."""
        signed = np.flatnonzero(np.abs(self.arms) > _NOTHING)
        changes = np.flatnonzero(np.diff(np.sign(self.arms[signed])))
        return tuple(float(self.angles[signed[i + 1]]) for i in changes)

    @cached_property
    def jumps(self) -> tuple[float, ...]:
        """The angles in rad at which the length of the path jumps because it slips off."""
        explained = -np.diff(self.angles) * (self.arms[1:] + self.arms[:-1]) / 2
        slips = np.flatnonzero(np.abs(np.diff(self.lengths) - explained) > 1e-3)
        return tuple(float(self.angles[i + 1]) for i in slips)


def moment_arms(model: Model) -> list[MomentArm]:
    """Compute the moment arm of every path about every hinge that it crosses.

    Each hinge turns over its limits, or over 150 degrees to either side. The other coordinates keep their initial
    values, and loops of bodies are not kept closed.

    Raises:
        InvalidSpec: The mechanics cannot be built.
        SimulationFailed: The initial pose cannot be computed.
    """
    physics = Physics(Program(model))
    physics.pose(model.values())
    hinges = {hinge.joint: hinge for hinge in _hinges(model, physics)}
    found = [arm for hinge in hinges.values() for arm in _of_points(model, physics, hinge)]
    for crossing in crossings(model, physics.assembly):
        hinge = hinges[crossing.joint]
        angles = hinge.angles[::_SMOOTH]
        arms, lengths = crossing.arms(angles)
        if np.max(np.abs(arms)) > _NOTHING:
            now = crossing.arm(hinge.now)
            found.append(hinge.arm(crossing.muscle, crossing.part, False, now, angles, arms, lengths))
    return found


@dataclass(frozen=True)
class _Hinge:
    """A hinge and the angles over which moment arms are computed; `now` is the angle in the initial pose."""

    part: Part
    joint: str
    place: int
    limited: bool
    backwards: bool | None
    alone: bool
    now: float
    angles: Floats

    def arm(
        self, muscle: str, path: Part, points: bool, now: float, angles: Floats, arms: Floats, lengths: Floats
    ) -> MomentArm:
        way = (self.limited, self.backwards, self.alone)
        return MomentArm(muscle, path, self.part, points, *way, now, angles, arms, lengths)


def _hinges(model: Model, physics: Physics) -> Iterator[_Hinge]:
    mechanics, data = physics.model, physics.data
    for i, tie in physics.assembly.reads:
        if tie.field != "qpos" or tie.element is None:
            continue
        joint = mechanics.joint(tie.element.name)
        if int(joint.type[0]) != int(mujoco.mjtJoint.mjJNT_HINGE):
            continue
        low, high = (float(limit) for limit in joint.range)
        limited = low < high
        place = tie_place(mechanics, tie)
        neutral = float(mechanics.qpos0[place])
        angles = np.linspace(low, high, _POINTS) if limited else neutral + np.linspace(-_FREE, _FREE, _POINTS)
        axis = data.xaxis[joint.id]
        backwards = bool(axis[1] > 0) if abs(axis[1]) > _SAGITTAL else None
        alone = int(mechanics.body_jntnum[int(joint.bodyid[0])]) == 1
        now = float(data.qpos[place])
        yield _Hinge(model.parts[i], tie.element.name, place, limited, backwards, alone, now, angles)


def _of_points(model: Model, physics: Physics, hinge: _Hinge) -> Iterator[MomentArm]:
    """The moment arms of paths through points about one hinge."""
    mechanics, data, pose = physics.model, physics.data, physics.data.qpos.copy()
    angles = np.append(hinge.angles, hinge.now)
    before, at, after = (_lengths(mechanics, data, pose, hinge.place, angles + turn) for turn in (-_TURN, 0.0, _TURN))
    for i, tie in physics.assembly.reads:
        if tie.field != "ten_length" or model.parts[i].type.kind != "path":
            continue
        tendon, path = tie_place(mechanics, tie), model.parts[i]
        arms = -(after[:, tendon] - before[:, tendon]) / (2 * _TURN)
        now = float(arms[-1])
        # If the path slips within the small rotation, the quotient is meaningless.
        arms[np.abs(arms) > 10] = np.nan
        known = np.flatnonzero(~np.isnan(arms[:-1]))
        if np.nanmax(np.abs(arms)) > _NOTHING:
            muscle = path.address.rpartition(".")[0] or path.address
            yield hinge.arm(muscle, path, True, now, angles[known], arms[known], at[known, tendon])


def _lengths(mechanics: Any, data: Any, pose: Floats, place: int, angles: Floats) -> Floats:
    """The lengths of all tendons in m: a row for each angle."""
    rows = np.zeros((len(angles), mechanics.ntendon))
    for k, angle in enumerate(angles):
        data.qpos[:] = pose
        data.qpos[place] = angle
        mujoco.mj_kinematics(mechanics, data)
        mujoco.mj_comPos(mechanics, data)
        mujoco.mj_tendon(mechanics, data)
        rows[k] = data.ten_length
    return rows
