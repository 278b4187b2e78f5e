"""Actuators: forces along a tendon, at a joint, or on a place."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.mechanics.making import Making
from gaitsim.compiler.mechanics.places import Point, Vector
from gaitsim.compiler.mechanics.ties import Element


class Actuators(Making):
    """Verbs that turn a control into a force."""

    def motor(
        self, element: Element, suffix: str = "motor", gain: Vector = (1, 0), limits: Vector | None = None
    ) -> Element:
        """Add an actuator along a tendon, where a positive force lengthens it, or at a joint.

        The force is control * (gain[0] + gain[1] * velocity), within the limits. MuJoCo solves the part with the
        velocity for the end of the step, so that a strong damper on a light segment is stable.

        Args:
            element: The tendon or the joint.
            suffix: The end of the actuator's name.
            gain: Constant and factor of the velocity.
            limits: Smallest and largest force in N or N m.
        """
        name = self._name(suffix)
        transmission = {
            "tendon": mujoco.mjtTrn.mjTRN_TENDON,
            "joint": mujoco.mjtTrn.mjTRN_JOINT,
        }[element.kind]
        actuator = self.spec.add_actuator(name=name, trntype=transmission, target=element.name, info=self._info)
        _drive(actuator, gain, limits)
        return Element("actuator", name)

    def push(
        self,
        place: Point,
        axis: Vector,
        suffix: str = "push",
        surface: str = "",
        reach: Vector = (0, 0, 0),
        gain: Vector = (1, 0),
        limits: Vector | None = None,
    ) -> Element:
        """Add an actuator on a place, along an axis of the world or of the ground that an inner part makes.

        Its actuator_length is the coordinate of the place on that axis, its actuator_velocity the rate of it. With
        `reach`, the force acts at that distance from the place, such as at the lowest point of a sphere. The velocity
        is then the one there, and the length has no use.

        Args:
            place: The place.
            axis: The direction.
            suffix: The end of the actuator's name.
            surface: The inner part that makes the ground; empty for the axes of the world.
            reach: The distance of the force from the place along the same axes, in m.
            gain: See `motor`.
            limits: See `motor`.
        """
        self.made.pushed.setdefault(self.index, []).append(axis)
        name, ground = self._name(suffix), self._name(f"{surface}.surface") if surface else "world.origin"
        if not surface and self.spec.site(ground) is None:
            self.spec.worldbody.add_site(name=ground, size=[0.005] * 3)
        if self.spec.site(self._name("place")) is None:
            self._site("place", place)
        actuator = self.spec.add_actuator(
            name=name,
            trntype=mujoco.mjtTrn.mjTRN_SITE,
            target=self._name("place"),
            refsite=ground,
            gear=[*(float(v) for v in axis), *np.cross(reach, axis)],
            info=self._info,
        )
        _drive(actuator, gain, limits)
        return Element("actuator", name)


def _drive(actuator: Any, gain: Vector, limits: Vector | None) -> None:
    """Set how the force of an actuator follows from its control; see `Actuators.motor`."""
    actuator.set_to_motor()
    if gain[1]:
        actuator.gaintype = mujoco.mjtGain.mjGAIN_AFFINE
        actuator.gainprm[:3] = [float(gain[0]), 0, float(gain[1])]
    else:
        actuator.gainprm[0] = float(gain[0])
    if limits is not None:
        actuator.forcelimited, actuator.forcerange = True, [float(limit) for limit in limits]
