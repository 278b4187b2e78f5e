"""Actuators: forces along a tendon, at a joint, or on a place."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.mechanics.making import Making
from gaitsim.compiler.mechanics.places import Point, Vector
from gaitsim.compiler.mechanics.ties import Element


class Actuators(Making):
    """Verbs that make a control a force."""

    def motor(
        self, element: Element, suffix: str = "motor", gain: Vector = (1, 0), limits: Vector | None = None
    ) -> Element:
        """An actuator along a tendon (positive lengthens) or at a joint.

        Its force is control * (gain[0] + gain[1] * velocity), kept within limits. The part with the
        velocity is solved for the velocity at the end of the step, so that a strong damper on a
        light segment stays a damper.
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
        """An actuator on a place along an axis of the world, or of the ground that an inner part makes.

        Its actuator_length is the place's coordinate on that axis, its actuator_velocity the rate. With
        `reach` the force acts that far from the place, in m along the same axes: at the lowest point of a
        sphere, say; the velocity is then the one there, the length of no use. For gain and limits see `motor`.
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
    """Set how an actuator's force follows from its control; see `Actuators.motor`."""
    actuator.set_to_motor()
    if gain[1]:
        actuator.gaintype = mujoco.mjtGain.mjGAIN_AFFINE
        actuator.gainprm[:3] = [float(gain[0]), 0, float(gain[1])]
    else:
        actuator.gainprm[0] = float(gain[0])
    if limits is not None:
        actuator.forcelimited, actuator.forcerange = True, [float(limit) for limit in limits]
