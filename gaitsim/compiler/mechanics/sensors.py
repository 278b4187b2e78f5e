"""Sensors of places and of the center of mass."""

from __future__ import annotations

from typing import Any

import mujoco

from gaitsim.compiler.mechanics.making import Making
from gaitsim.compiler.mechanics.places import Point
from gaitsim.compiler.mechanics.ties import Element


class Sensors(Making):
    """Verbs that let MuJoCo measure."""

    def position_of(self, place: Point, surface: str = "", suffix: str = "position") -> Element:
        """Add a sensor of the position of a place in the world, or relative to the ground of an inner part: three
        numbers in m.
        """
        sensor = self._sensor(suffix, mujoco.mjtSensor.mjSENS_FRAMEPOS, self._site(f"{suffix}.origin", place))
        if surface:
            made = self.spec.sensor(sensor.name)
            made.reftype, made.refname = mujoco.mjtObj.mjOBJ_SITE, self._name(f"{surface}.surface")
        return sensor

    def velocity_of(self, place: Point) -> Element:
        """A sensor of how a place moves in the world: three velocities, in m/s."""
        return self._sensor("velocity", mujoco.mjtSensor.mjSENS_FRAMELINVEL, self._site("velocity.origin", place))

    def orientation_of(self, place: Point) -> tuple[Element, Element]:
        """Add sensors of the z axis of a place in the world, and of its angular velocity in rad/s."""
        site = self._site("axis", place)
        axis = self._sensor("direction", mujoco.mjtSensor.mjSENS_FRAMEZAXIS, site)
        return axis, self._sensor("angular_velocity", mujoco.mjtSensor.mjSENS_FRAMEANGVEL, site)

    def axes_of(self, place: Point) -> tuple[Element, Element, Element, Element]:
        """Add sensors of the x, y and z axes of a place in the world, and of its angular velocity about them in
        rad/s.
        """
        site = self._site("axes", place)
        kinds = (
            mujoco.mjtSensor.mjSENS_FRAMEXAXIS,
            mujoco.mjtSensor.mjSENS_FRAMEYAXIS,
            mujoco.mjtSensor.mjSENS_FRAMEZAXIS,
        )
        x, y, z = (self._sensor(f"{name}_axis", kind, site) for name, kind in zip("xyz", kinds, strict=True))
        return x, y, z, self._sensor("gyroscope", mujoco.mjtSensor.mjSENS_GYRO, site)

    def center_of_mass(self) -> tuple[Element, Element]:
        """Add sensors of the position of the whole model's center of mass in m, and of its velocity in m/s."""
        body = mujoco.mjtObj.mjOBJ_BODY
        position = self._sensor("position", mujoco.mjtSensor.mjSENS_SUBTREECOM, "world", body)
        return position, self._sensor("velocity", mujoco.mjtSensor.mjSENS_SUBTREELINVEL, "world", body)

    def _sensor(self, suffix: str, kind: Any, of: str, what: Any = mujoco.mjtObj.mjOBJ_SITE) -> Element:
        name = self._name(suffix)
        self.spec.add_sensor(name=name, type=kind, objtype=what, objname=of, info=self._info)
        return Element("sensor", name)
