"""Initial poses that close the loops of bodies, by Newton's method on the coordinates that `initial:` leaves open."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.program import Floats
from gaitsim.errors import SimulationFailed

_CLOSED = 1e-12  # m or rad; MuJoCo's lengths are good to 1e-14 or so
_LARGEST_STEP = 0.5  # m or rad; a longer step may lead to another posture
_MOST_STEPS = 50


def close_loops(model: Any, data: Any, set_positions: Collection[int], set_velocities: Collection[int]) -> None:
    """Move the free coordinates of a pose, and then their velocities, so that all equality constraints hold.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data.
        set_positions: Indices of the coordinates that are given.
        set_velocities: Indices of the velocities that are given.

    Raises:
        SimulationFailed: No pose nearby closes the loops.
    """
    if model.neq == 0:
        return
    held = {int(model.jnt_dofadr[j]) for j in range(model.njnt) if int(model.jnt_qposadr[j]) in set_positions}
    free = [dof for dof in range(model.nv) if dof not in held]
    gap, rows = _gap(model, data)
    for _ in range(_MOST_STEPS):
        if _size(gap) <= _CLOSED:
            break
        gap, rows = _newton(model, data, gap, rows, free)
    if not _size(gap) <= _CLOSED:
        worst = model.equality(int(data.efc_id[int(np.argmax(np.abs(gap)))])).name.rpartition(".")[0]
        rule = f"no initial pose closes {worst}: a gap of {_size(gap):.3g} m or rad remains"
        raise SimulationFailed(f"{rule}; change what initial: sets, or set less of it")
    moving = [dof for dof in range(model.nv) if dof not in set_velocities]
    rate = rows @ data.qvel
    if _size(rate) > 0:
        data.qvel[moving] -= np.linalg.lstsq(rows[:, moving], rate)[0]
    if _size(rows @ data.qvel) > 1e-9 * (1 + _size(data.qvel)):
        rule = "no velocities of the coordinates that initial: does not set keep the loops of bodies closed"
        raise SimulationFailed(f"{rule}; change what initial: sets, or set less of it")


def _newton(model: Any, data: Any, gap: Floats, rows: Floats, free: list[int]) -> tuple[Floats, Floats]:
    """One step of Newton's method, shortened until the gap decreases."""
    step = np.zeros(model.nv)
    step[free] = -np.linalg.lstsq(rows[:, free], gap)[0]
    step *= min(1.0, _LARGEST_STEP / max(_size(step), _LARGEST_STEP))
    before = data.qpos.copy()
    closer, turned = gap, rows
    for _ in range(10):
        data.qpos[:] = before
        mujoco.mj_integratePos(model, data.qpos, step, 1.0)
        closer, turned = _gap(model, data)
        if _size(closer) < _size(gap):
            break
        step = step / 2
    return closer, turned


def _gap(model: Any, data: Any) -> tuple[Floats, Floats]:
    """The gap of each row of the equality constraints, and its derivatives."""
    mujoco.mj_fwdPosition(model, data)
    count = int(data.ne)
    rows = np.zeros((count, model.nv))
    if mujoco.mj_isSparse(model):
        for row in range(count):
            first, number = int(data.efc_J_rowadr[row]), int(data.efc_J_rownnz[row])
            places = slice(first, first + number)
            rows[row, np.ravel(data.efc_J_colind)[places]] = np.ravel(data.efc_J)[places]
    else:
        rows[:] = np.ravel(data.efc_J)[: count * model.nv].reshape(count, model.nv)
    return np.array(data.efc_pos[:count]), rows


def _size(vector: Floats) -> float:
    return float(np.max(np.abs(vector), initial=0.0))
