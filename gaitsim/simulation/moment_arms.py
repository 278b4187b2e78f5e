"""Moment arms of paths over hinges, each hinge turned alone from the initial pose."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.mjcf import tie_place
from gaitsim.compiler.program import Floats, Program
from gaitsim.model import Model, Part
from gaitsim.simulation.body import Body

_FREE = np.radians(150.0)  # to either side, of a hinge that declares no limits
_POINTS = 601
_TURN = 1e-6  # rad, for the derivative
_NOTHING = 1e-6  # m; a path that runs through the axis has no side


@dataclass(frozen=True)
class MomentArm:
    """The arm of one path over one hinge: positive where tension turns the hinge to larger angles.

    Angles in rad, arms and lengths in m.
    """

    path: Part
    hinge: Part
    limited: bool
    angles: Floats
    arms: Floats
    lengths: Floats

    @cached_property
    def turns(self) -> tuple[float, ...]:
        """Angles at which the arm changes its sign."""
        signed = np.flatnonzero(np.abs(self.arms) > _NOTHING)
        changes = np.flatnonzero(np.diff(np.sign(self.arms[signed])))
        return tuple(float(self.angles[signed[i + 1]]) for i in changes)

    @cached_property
    def jumps(self) -> tuple[float, ...]:
        """Angles at which the path slips: its length jumps, as no moment arm explains."""
        explained = -np.diff(self.angles) * (self.arms[1:] + self.arms[:-1]) / 2
        slips = np.flatnonzero(np.abs(np.diff(self.lengths) - explained) > 1e-3)
        return tuple(float(self.angles[i + 1]) for i in slips)


def moment_arms(model: Model) -> list[MomentArm]:
    """Every path over every hinge that it crosses, over the hinge's limits or 150 degrees to either side.

    The other coordinates stay as they are in the initial pose; loops of bodies are not kept closed.

    Errors: InvalidSpec, SimulationFailed.
    """
    body = Body(Program(model))
    body.pose(model.values())
    mechanics, data, pose = body.model, body.data, body.data.qpos.copy()
    paths = {
        tie_place(mechanics, tie): model.parts[i]
        for i, tie in body.assembly.reads
        if tie.field == "ten_length" and model.parts[i].type.kind == "path"
    }
    found = []
    for i, tie in body.assembly.reads:
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
        before, at, after = (_lengths(mechanics, data, pose, place, angles + turn) for turn in (-_TURN, 0.0, _TURN))
        for tendon, path in paths.items():
            arms = -(after[:, tendon] - before[:, tendon]) / (2 * _TURN)
            # Where the path slips within the tiny turn, the quotient means nothing.
            arms[np.abs(arms) > 10] = np.nan
            if np.nanmax(np.abs(arms)) > _NOTHING:
                known = ~np.isnan(arms)
                found.append(
                    MomentArm(path, model.parts[i], limited, angles[known], arms[known], at[known, tendon])
                )
    return found


def _lengths(mechanics: Any, data: Any, pose: Floats, place: int, angles: Floats) -> Floats:
    """Lengths of all tendons: a row for each angle."""
    rows = np.zeros((len(angles), mechanics.ntendon))
    for k, angle in enumerate(angles):
        data.qpos[:] = pose
        data.qpos[place] = angle
        mujoco.mj_kinematics(mechanics, data)
        mujoco.mj_comPos(mechanics, data)
        mujoco.mj_tendon(mechanics, data)
        rows[k] = data.ten_length
    return rows
