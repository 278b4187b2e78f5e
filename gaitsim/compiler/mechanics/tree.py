"""The tree of bodies: which joints carry which segment, from the ground upwards."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from gaitsim.errors import Faults, InvalidSpec, listed
from gaitsim.model import WORLD, Model, Part

FLAT = 0.02  # smallest singular value of unit axes below which they are dependent: within 2 deg of one plane


@dataclass(frozen=True)
class Branch:
    """A segment and the joints that carry it: one, or several with the same parent and child, outermost first."""

    segment: Part
    joints: tuple[Part, ...]


def branches(model: Model, values: Sequence[float]) -> list[Branch]:
    """All segments, each after the one that carries it.

    Raises:
        InvalidSpec: A segment has no joint, joints at different places, or is part of a ring.
    """
    faults = Faults()
    segments = {part.address: part for part in model.parts if part.type.frames}
    carried: dict[str, list[Part]] = {}
    children_of_ground: set[str] = set()
    for joint in (part for part in model.parts if {"parent", "child"} <= set(part.attachments)):
        child = _owner(joint.attachments["child"], segments)
        above = carried.setdefault(child, [])
        if child == WORLD:
            faults.add("its child is the ground; exchange parent and child.", model.place(joint), joint.address)
            children_of_ground.add(_owner(joint.attachments["parent"], segments))
        elif above and _ends(above[0], values) != _ends(joint, values):
            rule = f"{child} is the child of {above[0].address} and, at another place, of {joint.address}"
            move = "a segment is the child of one joint, or of several with the same parent and child"
            faults.add(f"{rule}; {move}.", model.place(joint), joint.address)
        else:
            above.append(joint)
    carried.pop(WORLD, None)
    for address, segment in segments.items():
        if address not in carried and address not in children_of_ground:
            first = next(iter(segment.type.frames))
            rule = f"no joint has this segment as its child; add one with child: {address}.{first}"
            faults.add(f"{rule}.", model.place(segment), address)
    faults.raise_if_any()
    return _ordered(model, segments, carried)


def _ordered(model: Model, segments: dict[str, Part], carried: dict[str, list[Part]]) -> list[Branch]:
    ordered: list[Branch] = []
    placed = {WORLD}
    while len(ordered) < len(segments):
        ready = [
            Branch(segments[child], tuple(joints))
            for child, joints in carried.items()
            if child not in placed and _owner(joints[0].attachments["parent"], segments) in placed
        ]
        if not ready:
            ring = ", ".join(address for address in segments if address not in placed)
            joint = next(joints[0] for child, joints in carried.items() if child not in placed)
            rule = f"joints connect these segments in a loop: {ring}; connect one of them to world."
            raise InvalidSpec(model.fault(joint, rule))
        ordered += ready
        placed |= {branch.segment.address for branch in ready}
    return ordered


def check_axes(model: Model, branch: Branch, body: Any) -> None:
    """Check that the axes of a body's hinges are independent, and the axes of its slides too.

    Raises:
        InvalidSpec: A joint adds no new direction.
    """
    parts = {joint.address: joint for joint in branch.joints}
    for kind, does in ((mujoco.mjtJoint.mjJNT_HINGE, "turn about"), (mujoco.mjtJoint.mjJNT_SLIDE, "move along")):
        axes: list[Any] = []
        names: list[str] = []
        for made in (joint for joint in body.joints if joint.type == kind):
            length = float(np.linalg.norm(made.axis))
            if length == 0:
                return  # MuJoCo says so
            axes.append(np.array(made.axis) / length)
            names.append(made.name)
            if len(axes) > 3 or np.linalg.svd(np.array(axes), compute_uv=False)[-1] < FLAT:
                part = parts.get(made.name) or parts[made.name.rpartition(".")[0]]
                before = listed(names[:-1], "and")
                rule = f"{branch.segment.address} can already {does} this axis by {before}"
                moves = ("choose another axis, or remove it", "choose an axis out of their plane", "remove it")
                move = moves[min(len(axes), 4) - 2]
                raise InvalidSpec(model.fault(part, f"{rule}; {move}."))


def _owner(frame: str, segments: dict[str, Part]) -> str:
    """The segment that a frame or a body belongs to."""
    return frame if frame == WORLD or frame in segments else frame.rpartition(".")[0]


def _ends(joint: Part, values: Sequence[float]) -> list[tuple[str, tuple[float, ...]]]:
    """The frame and the place beside it, for both ends of a joint."""
    ends = []
    for name in ("parent", "child"):
        places = joint.places.get(name, ())
        at = tuple(values[i] for place in places for i in place.at) or (0.0, 0.0, 0.0)
        ends.append((joint.attachments[name], at))
    return ends
