"""The figure of moment arms, and warnings about them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gaitsim.errors import Fault
from gaitsim.model import Model
from gaitsim.simulation.moment_arms import MomentArm


def warnings(model: Model, arms: Sequence[MomentArm]) -> list[Fault]:
    """Moment arms that change their sign within the range of the hinge, and paths that slip."""
    found = []
    for arm in arms:
        low, high = np.degrees(arm.angles[[0, -1]])
        over = f"{low:.0f} to {high:.0f} deg" + ("" if arm.limited else ", as the hinge has no limits")
        # A moment arm that is a function of the angle is valid beyond the range of the joint.
        if arm.turns and arm.alone and (arm.points or arm.limited):
            places = _degrees(arm.turns)
            rule = f"the moment arm over {arm.hinge.address} changes sign at {places} (range: {over})"
            move = "beyond it the path pulls the other way; wrap it around the joint, move its points or its side"
            found.append(Fault(f"{rule}; {move}.", model.place(arm.path), arm.path.address))
        elif arm.points and arm.jumps:
            rule = f"the length jumps at {_degrees(arm.jumps)} of {arm.hinge.address} (range: {over})"
            found.append(
                Fault(f"{rule}; move the cylinder's side or the points.", model.place(arm.path), arm.path.address)
            )
    return found


# The name of the motion in which a hanging child turns backwards, and of that in which it turns forwards.
# Out of the sagittal plane: the name for an increasing angle, and for a decreasing one.
_ACROSS = {"hip_adduction": ("adducts", "abducts"), "hip_rotation": ("rotates inwards", "rotates outwards")}
_HIP = ("extends", "flexes")
_SENSES = {"hip": _HIP, "hip_flexion": _HIP, "knee": ("flexes", "extends"), "ankle": ("plantarflexes", "dorsiflexes")}


def sentence(arm: MomentArm) -> str:
    """In which direction a muscle turns a joint in the initial pose, such as "leg_l.soleus plantarflexes leg_l.ankle
    (...)".
    """
    if abs(arm.initial) < 1e-6:
        return f"{arm.muscle} does not turn {arm.hinge.address} at the start"
    if arm.backwards is None:
        ways = _ACROSS.get(_bare(arm.hinge.address), ("turns", "turns back"))
        return f"{arm.muscle} {ways[0 if arm.initial > 0 else 1]} {arm.hinge.address}"
    back = (arm.initial > 0) == arm.backwards
    # A child that is fastened by its distal end is the segment above the joint.
    frame = arm.hinge.attachments["child"].rpartition(".")[2]
    sense = _SENSES.get(_bare(arm.hinge.address))
    does = sense[0 if back != (frame == "distal") else 1] if sense else "turns"
    how = "backwards" if back else "forwards"
    return f"{arm.muscle} {does} {arm.hinge.address} (the child turns {how})"


def table(arms: Sequence[MomentArm]) -> list[dict[str, Any]]:
    """For each moment arm: muscle, joint and direction in words, and the arm in the initial pose in m, positive
    where the angle increases.
    """
    return [
        {"muscle": arm.muscle, "joint": arm.hinge.address, "says": sentence(arm), "arm": arm.initial, "unit": "m"}
        for arm in arms
    ]


def _bare(address: str) -> str:
    """The last word of an address, without its side."""
    return address.rpartition(".")[2].removesuffix("_l").removesuffix("_r")


def draw(arms: Sequence[MomentArm], file: Path, title: str) -> None:
    """Write a PNG with one panel for each hinge: moment arms in cm over the angle in degrees.

    Args:
        arms: The moment arms.
        file: The PNG.
        title: The title of the figure.
    """
    from matplotlib.figure import Figure

    hinges = list(dict.fromkeys(arm.hinge.address for arm in arms))
    columns = min(3, len(hinges))
    rows = -(-len(hinges) // columns)
    figure = Figure(figsize=(5.2 * columns + 0.6, 3.8 * rows + 0.5), layout="constrained", dpi=150)
    figure.suptitle(f"{title}\npositive: tension makes the angle grow", fontsize=10)
    for k, hinge in enumerate(hinges):
        axes = figure.add_subplot(rows, columns, k + 1)
        mine = [arm for arm in arms if arm.hinge.address == hinge]
        for arm in mine:
            axes.plot(*_with_gaps(arm), label=arm.muscle)
            for turn in arm.turns:
                axes.axvline(np.degrees(turn), color="tab:red", linewidth=0.8, linestyle=":")
        axes.axhline(0, color="black", linewidth=0.8)
        limits = "its limits" if mine[0].limited else "no limits declared"
        axes.set_title(f"{hinge} ({limits})", fontsize=10)
        axes.set_xlabel(f"{hinge}.angle (deg)")
        axes.set_ylabel("moment arm (cm)")
        axes.margins(x=0)
        low, high = axes.get_ylim()
        axes.set_ylim(min(low, -0.5), max(high, 0.5))
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file)


def _with_gaps(arm: MomentArm) -> tuple[list[float], list[float]]:
    """Angles in degrees and arms in cm, with gaps where the path slips."""
    angles, arms = [], []
    for angle, value in zip(arm.angles, arm.arms, strict=True):
        if arm.points and float(angle) in arm.jumps:
            angles.append(float(np.degrees(angle)))
            arms.append(float("nan"))
        angles.append(float(np.degrees(angle)))
        arms.append(100 * float(value))
    return angles, arms


def _degrees(angles: Sequence[float]) -> str:
    return " and ".join(f"{np.degrees(angle):.0f} deg" for angle in angles)
