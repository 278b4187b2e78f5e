"""Moment arms of paths through points along a recorded motion."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.mjcf import tie_place
from gaitsim.compiler.program import Floats, Program
from gaitsim.model import Model
from gaitsim.simulation.outcome import Trajectory
from gaitsim.simulation.physics import Physics

_INTERVAL = 5e-3  # s; arms change slowly, so that they are taken this often and interpolated


def tendon_arms(model: Model, trajectory: Trajectory, hinge: str) -> dict[str, Floats]:
    """The moment arms of paths through points about a hinge along a recorded motion.

    Returns:
        The arm in m at each instant by the address of the path, positive where tension increases the angle; only of
        paths that cross the hinge. Arms are computed every 5 ms and interpolated between.
    """
    physics = Physics(Program(model))
    physics.pose(model.values())
    reads = [(model.parts[i], tie) for i, tie in physics.assembly.reads]
    paths = [(part, tie) for part, tie in reads if tie.field == "ten_length" and part.type.kind == "path"]
    tendons = {part.address: tie_place(physics.model, tie) for part, tie in paths}
    times = trajectory.times
    if not tendons or not len(times):
        return {}
    coordinates = {tie_place(physics.model, tie): (p.address, tie) for p, tie in reads if tie.field == "qpos"}
    turned = next((tie.element.name for part, tie in coordinates.values() if part == hinge and tie.element), None)
    if turned is None:
        return {}
    freedom = int(physics.model.joint(turned).dofadr[0])
    signals = {place: trajectory[f"{part}.{tie.port}"] for place, (part, tie) in coordinates.items()}
    taken = np.unique(np.append(np.searchsorted(times, np.arange(times[0], times[-1], _INTERVAL)), len(times) - 1))
    rows = np.array([_arms(physics.model, physics.data, signals, row)[:, freedom] for row in taken])
    return {
        path: np.interp(times, times[taken], rows[:, tendon])
        for path, tendon in tendons.items()
        if np.any(rows[:, tendon])
    }


def _arms(mechanics: Any, data: Any, signals: dict[int, Floats], row: int) -> Floats:
    """The moment arms of all tendons about all degrees of freedom, in the posture of one instant."""
    data.qpos[list(signals)] = [signal[row] for signal in signals.values()]
    mujoco.mj_kinematics(mechanics, data)
    mujoco.mj_comPos(mechanics, data)
    mujoco.mj_tendon(mechanics, data)
    full = np.zeros((mechanics.ntendon, mechanics.nv))
    mujoco.mju_sparse2dense(full, data.ten_J, mechanics.ten_J_rownnz, mechanics.ten_J_rowadr, mechanics.ten_J_colind)
    return -full
