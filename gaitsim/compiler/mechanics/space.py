"""Checks of models in space: parts that are valid in the sagittal plane only, and parts on one side only."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mujoco

from gaitsim.compiler.mechanics.making import Made
from gaitsim.errors import Faults
from gaitsim.model import Model

_STRAIGHT = 1e-6  # deviation of a unit axis from the sagittal plane, or from the normal of that plane


def check_friction(model: Model, spec: Any, made: Made) -> None:
    """Check that contacts of bodies that can move sideways have friction sideways.

    Raises:
        InvalidSpec: A contact has friction along the direction forwards only.
    """
    faults = Faults()
    for index, body in made.carried.items():
        axes = made.pushed.get(index, ())
        if any(axis[0] for axis in axes) and not any(axis[1] for axis in axes):
            joint = _out_of_plane(spec.body(body))
            if joint:
                part = model.parts[index]
                rule = f"{part.type.reference} has no friction sideways, and {joint} lets it move there"
                move = "choose a contact for space, such as contact/spatial_hunt_crossley"
                faults.add(f"{rule}; {move}.", model.place(part), part.address)
    faults.raise_if_any()


def check_inertias(model: Model, spec: Any, made: Made) -> None:
    """Check that segments with one inertia, about the transverse axis, turn about that axis only.

    Raises:
        InvalidSpec: A joint turns one about another axis.
    """
    faults = Faults()
    for part in (model.parts[index] for index in made.planar):
        joint = _out_of_plane(spec.body(part.address), slides=False)
        if joint:
            what, mark = part.type.reference, model.place(part)
            rule = f"{what} has one inertia, about its transverse axis, and {joint} turns it about others"
            chosen = next((group.reference for group in model.groups if group.mark == mark), what)
            faults.add(f"{rule}; choose segment/spatial in place of {chosen}.", mark, part.address)
    faults.raise_if_any()


def check_grounds(model: Model, made: Made) -> None:
    """Check that there is one ground.

    Raises:
        InvalidSpec: There are two.
    """
    faults = Faults()
    uneven = {name.rpartition(".")[0] for name in made.reliefs}
    grounds = [part for part in model.parts if part.type.kind == "terrain"]
    if made.reliefs and (len(set(made.reliefs.values())) > 1 or {part.address for part in grounds} - uneven):
        part = next((part for part in grounds if part.address not in uneven), grounds[-1])
        rule = "a model has one ground, and another contact has a different one; write one for all"
        faults.add(f"{rule}: use_for: {{terrain: {{use: terrain/rough}}}}.", model.place(part), part.address)
    faults.raise_if_any()


def check_sides(model: Model, values: Sequence[float]) -> None:
    """Check that parts beside the middle of a mirrored segment are mirrored too.

    Raises:
        InvalidSpec: A part is not.
    """
    faults = Faults()
    mirrored = {part.address for part in model.parts if part.mirrored and part.type.frames}
    for part in (part for part in model.parts if not part.mirrored):
        for name, places in {**part.points, **part.places}.items():
            for place in places:
                owner = place.frame if place.frame in mirrored else place.frame.rpartition(".")[0]
                if owner in mirrored and values[place.at[1]] != 0:
                    rule = (
                        f"{name} has a place on {owner}, which is the mirror of a right one, but is itself not mirrored"
                    )
                    move = "write it once, as on the right, with sides: [l, r] or sides: [l]"
                    faults.add(f"{rule}; {move}.", model.place(part), part.address)
                    break
    faults.raise_if_any()


def _out_of_plane(body: Any, slides: bool = True) -> str:
    """The first joint, from a body down to the ground, that moves it out of the sagittal plane; empty if none does.

    Args:
        body: The body.
        slides: Whether joints count that move the body without turning it.
    """
    while body is not None:
        for joint in body.joints:
            x, y, z = (abs(float(v)) for v in joint.axis)
            slide = joint.type == mujoco.mjtJoint.mjJNT_SLIDE
            if (slides and y > _STRAIGHT) if slide else max(x, z) > _STRAIGHT * y:
                return str(joint.name)
        body = body.parent
    return ""
