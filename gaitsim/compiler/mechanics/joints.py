"""Joints: how a body moves relative to the one that carries it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mujoco

from gaitsim.compiler.mechanics.making import Making
from gaitsim.compiler.mechanics.places import Lift, Vector
from gaitsim.compiler.mechanics.ties import Element


class Joints(Making):
    """Verbs for the motion of the part's child, and for its start."""

    def slide(self, axis: Vector, suffix: str = "", damping: float = 0.0, armature: float = 0.0) -> Element:
        """Add a translation of the child along an axis; damping in N s/m, armature in kg as for `hinge`."""
        joint = self._joint(mujoco.mjtJoint.mjJNT_SLIDE, self._mirrored(axis), suffix, damping)
        self.spec.joint(joint.name).armature = float(armature)
        return joint

    def hinge(
        self,
        axis: Vector,
        suffix: str = "",
        damping: float = 0.0,
        limits: Sequence[float] | None = None,
        neutral: float = 0.0,
        armature: float = 0.0,
    ) -> Element:
        """Add a rotation of the child about an axis.

        Args:
            axis: The axis.
            suffix: The end of the joint's name.
            damping: In N m s/rad.
            limits: The range in rad, for plots only; forces at its ends are up to the part.
            neutral: The coordinate in rad at which the frames are aligned.
            armature: Inertia of this coordinate alone in kg m^2, such as that of a motor's rotor.
        """
        x, y, z = (float(v) for v in axis)
        # An axis is a pseudovector: a mirror image in y reverses its x and z and keeps its y.
        turned = (-x, y, -z) if self.part.mirrored else (x, y, z)
        joint = self._joint(mujoco.mjtJoint.mjJNT_HINGE, turned, suffix, damping)
        made = self.spec.joint(joint.name)
        made.ref, made.armature = float(neutral), float(armature)
        if limits is not None:
            made.range, made.limited = [float(limit) for limit in limits], False
        return joint

    def begins_at(self, joint: Element, position: float, velocity: float) -> None:
        """Set the coordinate and velocity with which a joint starts, in SI, unless `initial:` sets them."""
        self.made.begins.append((joint.name, float(position), float(velocity)))

    def stands_on(self, lift: Element, load: float = 0.0) -> None:
        """Let this vertical joint start with the lowest contact on the ground, unless `initial:` sets it.

        Args:
            lift: The joint.
            load: The share of the body weight that the ground then carries, as the sum of the outputs `load` of all
                contacts. With 0, the lowest contact just touches the ground.
        """
        self.made.lifts.append(Lift(self.index, lift.name, float(load)))

    def _joint(self, kind: Any, axis: Vector, suffix: str, damping: float) -> Element:
        child = self.attached("child")
        child.body.add_joint(
            name=self._name(suffix),
            type=kind,
            axis=list(axis),
            pos=list(child.position),
            damping=[float(damping), 0, 0],
            info=self._info,
        )
        return Element("joint", self._name(suffix))
