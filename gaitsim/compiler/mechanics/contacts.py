"""Contacts: the ground, and bodies that it carries."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import mujoco

from gaitsim.compiler.mechanics.actuators import Actuators
from gaitsim.compiler.mechanics.ground import add_ground, add_surface
from gaitsim.compiler.mechanics.places import Point, Relief, Touching, Vector
from gaitsim.compiler.mechanics.ports import Ports
from gaitsim.compiler.mechanics.sensors import Sensors
from gaitsim.compiler.mechanics.ties import Element

_AWAY = 1000.0  # m below the origin, where a plane is until it follows its sphere


class Contacts(Actuators, Sensors, Ports):
    """Verbs for the ground and for contacts with it."""

    def ground(
        self,
        angle: float = 0.0,
        edges: Sequence[tuple[float, float]] = (),
        across: float = 0.0,
        relief: tuple[Callable[..., Sequence[float]], tuple[float, ...]] | None = None,
    ) -> None:
        """Make the ground of the whole model.

        `push` and `position_of` of the part around this one count from this ground if they name this part.

        Args:
            angle: The slope forwards, in rad.
            edges: Steps: positions along the ground and the heights behind them, in m.
            across: The slope to the left, in rad, about the direction forwards along the ground.
            relief: For level ground with bumps, a function and its first arguments; two more are a place, forwards and
                to the left. It gives the height there in m, and how much it grows in either direction.
        """
        if relief is not None:
            self.made.reliefs[self._name("surface")] = Relief(*relief)
        self.made.slopes[self._name("surface")] = (angle, across)
        add_surface(self.spec, self._name("surface"), angle, across, self._info)
        add_ground(self.spec, angle, across, edges, self._info)

    def collide(self, place: Point, radius: float, friction: float, solref: Vector, solimp: Vector) -> Element:
        """Add a sphere that MuJoCo keeps above the ground.

        Args:
            place: Its center.
            radius: In m.
            friction: The coefficient of friction.
            solref: MuJoCo's solref.
            solimp: MuJoCo's solimp.

        Returns:
            The sensor of its force on the ground, in N.
        """
        # With the pyramidal cone the depth at rest would depend on friction: 1.6 to 100 mm for 0.5 to 2.
        self.spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        self.made.collided.append(self.index)
        sphere = self._name("sphere")
        place.body.add_geom(
            name=sphere,
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            pos=list(place.position),
            size=[float(radius), 0, 0],
            mass=0,
            contype=0,
            conaffinity=1,
            priority=1,  # its parameters apply, not the mean of them and the ground's
            friction=[float(friction), 0.005, 0.0001],
            solref=[float(v) for v in solref],
            solimp=[float(v) for v in solimp],
            info=self._info,
        )
        sensor = self._sensor("touch", mujoco.mjtSensor.mjSENS_CONTACT, sphere, mujoco.mjtObj.mjOBJ_GEOM)
        made = self.spec.sensor(sensor.name)
        made.intprm = [1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE), 3, 1]  # the force alone, net of all contacts
        return sensor

    def follow_ground(
        self, forward: str, left: str, up: str, tilt: str, gradient: str, side_gradient: str, surface: str
    ) -> None:
        """Let the sphere of `collide` rest on uneven ground, if an inner part makes that.

        The sphere then touches no ground but a plane of its own. Ports move this plane, so that it is tangent to the
        ground below the sphere. In the first step it is out of reach.

        Args:
            forward: The port with the position of the ground below the sphere, forwards, in m.
            left: The port with that position to the left.
            up: The port with that position upwards.
            tilt: The port with 1 + sqrt(1 + g^2 + h^2). With h and -g it is a quaternion that turns the plane.
            gradient: The port with g: how much the ground rises forwards.
            side_gradient: The port with h: how much it rises to the left.
            surface: The inner part.
        """

        def follow() -> None:
            if self._name(f"{surface}.surface") not in self.made.reliefs:
                return
            plane = self._plane_below(self.spec.geom(self._name("sphere")))
            for index, port in enumerate((forward, left, up)):
                self.apply(port, plane, "mocap_pos", index)
            for index, port, sign in ((0, tilt, 1), (1, side_gradient, 1), (2, gradient, -1)):
                self.apply(port, plane, "mocap_quat", index, sign)

        self.made.later.append(follow)

    def _plane_below(self, sphere: Any) -> Element:
        """A plane that only one sphere touches, with the numbers of that sphere. Ports move it."""
        name, (slide, spin, roll) = self._name("ground"), sphere.friction
        body = self.spec.worldbody.add_body(name=name, mocap=True, pos=[0, 0, -_AWAY], info=self._info)
        body.add_geom(
            name=name,
            type=mujoco.mjtGeom.mjGEOM_PLANE,
            size=[1, 1, 0.1],
            rgba=[0, 0, 0, 0],
            **self._massless,
        )
        sphere.conaffinity = 0
        self.spec.add_pair(
            name=name,
            geomname1=name,
            geomname2=sphere.name,
            condim=sphere.condim,
            friction=[slide, slide, spin, roll, roll],
            solref=sphere.solref,
            solimp=sphere.solimp,
            info=self._info,
        )
        return Element("mocap", name)

    def read_slopes(self, forward: str, left: str, surface: str) -> None:
        """Let two outputs be the slopes, in rad, of the mean ground that an inner part makes.

        Args:
            forward: The output with the slope forwards.
            left: The output with the slope to the left, about the direction forwards along the ground.
            surface: The inner part.
        """
        slopes, name = self.made.slopes, self._name(f"{surface}.surface")
        self._read_constant(forward, lambda model: slopes[name][0])
        self._read_constant(left, lambda model: slopes[name][1])

    def tilt(self, place: Point, surface: str, forward: str, left: str | None = None) -> None:
        """Push a place along the ground of an inner part by outputs in N, if that ground rises from place to place.

        Other ground gets no actuators for this.

        Args:
            place: The place.
            surface: The inner part that makes the ground.
            forward: The output with the force forwards along the mean ground.
            left: The output with the force to the left.
        """

        def push() -> None:
            if self._name(f"{surface}.surface") in self.made.reliefs:
                for port, axis, suffix in ((forward, (1, 0, 0), "tilt"), (left, (0, 1, 0), "side_tilt")):
                    if port is not None:
                        self.apply(port, self.push(place, axis, suffix=suffix, surface=surface), "ctrl")

        self.made.later.append(push)

    def touches(self, place: Point, radius: float = 0.0) -> None:
        """Declare that the ground carries the body at a point, or at a sphere with a radius in m."""
        self.made.touching.append(Touching(place.body.name, place.position, float(radius)))
        self.made.carried[self.index] = place.body.name
