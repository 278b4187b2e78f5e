"""Motion of a walker in space out of the sagittal plane, over the gait cycle: pelvis, hip, medial force."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import GREY, above, labelled, panels
from gaitsim.analysis.gait.joint_moments import joint_moment
from gaitsim.analysis.gait.keypoints import ACROSS, ACROSS_BY, draw_peaks, name_peaks
from gaitsim.analysis.gait.legs import Leg, mass, side_of, unsided
from gaitsim.analysis.gait.panels import BAND, draw_cycle, strides_text
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay
from gaitsim.model import Model, Part

_ORIENTATION = "sensor/spatial_orientation"
_HINGE = "joint/spatial_hinge"


def frontal_figures(replay: Replay, legs: Sequence[Leg]) -> list[Drawing]:
    """Obliquity and rotation of the pelvis, angles and abduction moment of the hip, and medial force; none for a model
    in the plane.
    """
    found = {name: curves for name, curves in _curves(replay, legs).items() if len(curves) == len(legs)}
    if not found:
        return []
    figure, axes = panels(len(found), 1, height=1.6, share=True)
    for panel, (name, curves) in zip(axes, found.items(), strict=True):
        factor, label = _SCALES.get(name, (float(np.degrees(1)), labelled(name, "deg")))
        for leg in legs:
            draw_cycle(panel, leg, leg.over_cycle(curves[leg.side]), factor)
        draw_peaks(panel, ACROSS.get(name, ()))
        panel.axhline(0, color=GREY, linewidth=0.8)
        panel.set_ylabel(label)
    known = [panel for panel, name in zip(axes, found, strict=True) if name in ACROSS]
    if known:
        name_peaks(known[0])
    above(axes[0])
    axes[-1].set_xlabel(labelled("gait cycle", "%"))
    people = f" Green: peaks of adults ({ACROSS_BY})." if known else ""
    caption = (
        f"Out of the sagittal plane: {strides_text(legs)}. The obliquity is positive while the leg's own side of "
        "the pelvis is raised, its rotation while that side is in front; rotation of the hip inwards is positive, "
        "the moment of the hip where it abducts the thigh or raises the other side of the pelvis, and the force "
        f"of the ground towards the other foot. {BAND} Dotted: take-off.{people}"
    )
    return [Drawing("gait_frontal", "Motion and force out of the sagittal plane over the gait cycle", caption, figure)]


_MEDIAL = "medial force"
_ABDUCTION = "hip abduction moment"
# Factor and label of what is not an angle.
_SCALES = {_ABDUCTION: (1.0, "abduction (N m/kg)"), _MEDIAL: (1.0, "medial (body weights)")}


def _curves(replay: Replay, legs: Sequence[Leg]) -> dict[str, dict[str, Floats]]:
    """Each quantity by the side of a leg, in rad, N m/kg or body weights."""
    signals = replay.trajectory
    found: dict[str, dict[str, Floats]] = {}
    for leg in legs:
        pelvis = _pelvis(replay.model, leg.side)
        if pelvis:
            found.setdefault("pelvic obliquity", {})[leg.side] = signals[f"{pelvis}.rise"]
            found.setdefault("pelvic rotation", {})[leg.side] = signals[f"{pelvis}.yaw"]
        for hinge in _of_type(replay.model, _HINGE, leg.side):
            own = unsided(hinge.address).replace("_", " ")
            name = re.sub("abduction$", "adduction", own)
            sign = 1 if name == own else -1
            if name.endswith(("adduction", "rotation")):
                found.setdefault(name, {})[leg.side] = sign * signals[f"{hinge.address}.angle"]
            moment = joint_moment(replay, hinge.address) if name == "hip adduction" else None
            if moment is not None:
                found.setdefault(_ABDUCTION, {})[leg.side] = -sign * moment / mass(replay, leg)
        sideways = [f"{contact}.side_force" for contact in leg.contacts]
        if leg.weight > 0 and all(signal in signals.signals for signal in sideways):
            inwards = (1 if leg.side == "r" else -1) / leg.weight
            found.setdefault(_MEDIAL, {})[leg.side] = inwards * np.sum([signals[one] for one in sideways], axis=0)
    return found


def _pelvis(model: Model, side: str) -> str:
    """The sensor of the orientation of a segment without a side; empty if there is none."""
    sensors = _of_type(model, _ORIENTATION, side)
    return next((part.address for part in sensors if not side_of(part.attachments["frame"])), "")


def _of_type(model: Model, reference: str, side: str) -> list[Part]:
    return [part for part in model.parts if part.type.reference == reference and side_of(part.address) == side]
