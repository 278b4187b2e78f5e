"""Initial angles at which the hinges of a joint cannot turn it about every direction."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.mechanics.tree import FLAT
from gaitsim.compiler.mjcf import tie_place
from gaitsim.errors import Fault
from gaitsim.model import Model
from gaitsim.simulation.physics import Physics


def singular_axes(model: Model, physics: Physics) -> Iterator[Fault]:
    """Joints of three hinges whose axes lie in one plane.

    The angle of the second hinge decides this: it turns the third axis relative to the first.

    Args:
        model: The model.
        physics: Its mechanics in the initial pose.

    Yields:
        One fault for each such joint, at the angle of its second hinge.
    """
    mechanics, data = physics.model, physics.data
    for body in range(1, mechanics.nbody):
        hinges = _hinges(mechanics, body)
        if len(hinges) == 3 and np.linalg.svd(data.xaxis[hinges], compute_uv=False)[-1] < FLAT:
            yield _fault(model, physics, hinges)


def _hinges(mechanics: Any, body: int) -> list[int]:
    first = int(mechanics.body_jntadr[body])
    joints = range(first, first + int(mechanics.body_jntnum[body]))
    return [joint for joint in joints if mechanics.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE]


def _fault(model: Model, physics: Physics, hinges: list[int]) -> Fault:
    place = int(physics.model.jnt_qposadr[hinges[1]])
    first, middle, last = (physics.model.joint(joint).name for joint in hinges)
    shown = f"{math.degrees(physics.data.qpos[place]):.4g} deg"
    rule = f"at {shown} the axes of {first}, {middle} and {last} lie within 2 deg of one plane, so that they turn the "
    rule += "child about two directions only"
    move = f"start with another {middle}, or order the hinges so that the second one stays away from this angle"
    for index, tie in physics.assembly.reads:
        if tie.field == "qpos" and tie_place(physics.model, tie) == place:
            part = model.parts[index]
            address = f"{part.address}.{tie.port}"
            initial = model.initial.get(address)
            mark = model.place(part) if initial is None else model.numbers[initial].mark
            return Fault(f"{rule}; {move}.", mark, address)
    return Fault(f"{rule}; {move}.", None, middle)
