"""What a component's `build(p, mj)` works on: bodies, joints, tendons and their ties to ports."""

from __future__ import annotations

import itertools
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.ground import add_ground, add_surface
from gaitsim.compiler.places import DrawnForce, DrawnLine, Frames, Moved, Point, Touching, Vector, Wrap
from gaitsim.compiler.ties import Element, Tie, tied
from gaitsim.errors import did_you_mean
from gaitsim.model import Part


@dataclass
class Mechanics:
    """The MuJoCo side of one part: everything it makes bears its address and its place in the spec.

    Positions are in the frame of the part's own body: x forwards, y to the left, z up. What is
    written for the right side is mirrored in y for the left.
    """

    spec: Any
    part: Part
    frames: Frames
    dressed: bool = True
    own_body: Any = None
    reads: list[Tie] = field(default_factory=list)
    applies: list[Tie] = field(default_factory=list)
    constants: list[Callable[[Any], float]] = field(default_factory=list)
    drawings: list[DrawnLine | DrawnForce] = field(default_factory=list)
    touching: list[Touching] = field(default_factory=list)
    lifts: list[str] = field(default_factory=list)
    begins: list[tuple[str, float, float]] = field(default_factory=list)

    @property
    def _info(self) -> str:
        return str(self.part.mark)

    def _name(self, suffix: str) -> str:
        return f"{self.part.address}.{suffix}" if suffix else self.part.address

    def _mirrored(self, vector: Vector) -> tuple[float, float, float]:
        x, y, z = (float(v) for v in vector)
        return (x, -y if self.part.mirrored else y, z)

    def body(self, mass: float, center_of_mass: Vector, inertia: Vector) -> None:
        """Mass in kg, center of mass in m, principal moments of inertia there in kg m^2."""
        self.own_body.mass = float(mass)
        self.own_body.ipos = self._mirrored(center_of_mass)
        self.own_body.inertia = [float(i) for i in inertia]
        self.own_body.explicitinertial = True

    def frame(self, name: str, position: Vector) -> None:
        """Where a declared frame lies on the part's own body, in m."""
        self.frames.places[self._name(name)] = Point(self.own_body, self._mirrored(position))

    def slide(self, axis: Vector, suffix: str = "", damping: float = 0.0) -> Element:
        """A translation of the child along an axis; damping in N s/m."""
        return self._joint(mujoco.mjtJoint.mjJNT_SLIDE, self._mirrored(axis), suffix, damping)

    def hinge(
        self,
        axis: Vector,
        suffix: str = "",
        damping: float = 0.0,
        limits: Sequence[float] | None = None,
        neutral: float = 0.0,
        armature: float = 0.0,
    ) -> Element:
        """A rotation of the child about an axis; damping in N m s/rad.

        Its coordinate is `neutral` (rad) where the frames are aligned. Limits in rad are told to
        whoever plots the joint; what happens there is the part's own. The armature (kg m^2) is
        inertia of this coordinate alone, such as that of a drive's rotor.
        """
        x, y, z = (float(v) for v in axis)
        # An axis is a pseudovector: mirrored in y, its x and z turn round and its y stays.
        turned = (-x, y, -z) if self.part.mirrored else (x, y, z)
        joint = self._joint(mujoco.mjtJoint.mjJNT_HINGE, turned, suffix, damping)
        made = self.spec.joint(joint.name)
        made.ref, made.armature = float(neutral), float(armature)
        if limits is not None:
            made.range, made.limited = [float(limit) for limit in limits], False
        return joint

    def _joint(self, kind: Any, axis: Vector, suffix: str, damping: float) -> Element:
        child = self.frames.point(self.part.attachments["child"])
        child.body.add_joint(
            name=self._name(suffix),
            type=kind,
            axis=list(axis),
            pos=list(child.position),
            damping=[float(damping), 0, 0],
            info=self._info,
        )
        return Element("joint", self._name(suffix))

    def attached(self, name: str, offset: Vector = (0, 0, 0)) -> Point:
        """The place of one of the part's attachments, moved by an offset in m."""
        return self.frames.point(self.part.attachments[name], self._mirrored(offset))

    def tendon(self, places: Sequence[Point | Wrap], suffix: str = "") -> Element:
        """A tendon through points and around cylinders, straight between them."""
        tendon = self.spec.add_tendon(name=self._name(suffix), info=self._info)
        for i, place in enumerate(places):
            if isinstance(place, Wrap):
                tendon.wrap_geom(place.geom, place.side)
            else:
                tendon.wrap_site(self._site(f"{suffix}.points.{i}".lstrip("."), place))
        return Element("tendon", self._name(suffix))

    def tendon_between(self, first: str, second: str) -> Element:
        """A straight tendon between two of the part's attachments."""
        return self.tendon([self.attached(name) for name in (first, second)])

    def cylinder(self, center: Point, radius: float, side: Point, axis: Vector = (0, 1, 0)) -> Wrap:
        """A massless cylinder for tendons to bend around, at the side of a place; radius in m."""
        geom = self._name("cylinder")
        quat = np.zeros(4)
        mujoco.mju_quatZ2Vec(quat, np.array(axis, dtype=np.float64))
        center.body.add_geom(
            name=geom,
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            pos=list(center.position),
            quat=quat,
            size=[float(radius), 0.02, 0],
            **self._massless,
        )
        return Wrap(geom, self._site("side", side))

    def equal_lengths(self, first: Element, second: Element, time_constant: float, impedance: float) -> None:
        """Keep two tendons equally long: one row of MuJoCo's equality constraints, critically damped."""
        equality = self.spec.add_equality(
            name=self._name("equality"),
            type=mujoco.mjtEq.mjEQ_TENDON,
            name1=first.name,
            name2=second.name,
            solref=[float(time_constant), 1],
            solimp=[float(impedance), float(impedance), 0.001, 0.5, 2],
            info=self._info,
        )
        # MuJoCo counts from the lengths in the posture where all coordinates are 0.
        ahead = self._length_at_zero(second) - self._length_at_zero(first)
        equality.data[:5] = [ahead, 1, 0, 0, 0]

    def _length_at_zero(self, tendon: Element) -> float:
        ends = [wrap.target for wrap in self.spec.tendon(tendon.name).path]
        places = []
        for site in ends:
            place, body = np.array(site.pos), site.parent
            while body is not None:
                place, body = place + body.pos, body.parent
            places.append(place)
        return float(sum(np.linalg.norm(b - a) for a, b in itertools.pairwise(places)))

    def _site(self, suffix: str, point: Point, radius: float = 0.005) -> str:
        name = self._name(suffix)
        point.body.add_site(name=name, pos=list(point.position), size=[radius] * 3, info=self._info)
        return name

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

    def ground(self, angle: float = 0.0, edges: Sequence[tuple[float, float]] = ()) -> None:
        """The ground of the whole model: it rises forwards by an angle (rad) and has steps at its edges.

        An edge is a position along it and the height behind it, in m. `push` and `position_of` of
        the part around this one count from it if they are given this one's name.
        """
        add_surface(self.spec, self._name("surface"), angle, self._info)
        add_ground(self.spec, angle, edges, self._info)

    def collide(self, place: Point, radius: float, friction: float, solref: Vector, solimp: Vector) -> Element:
        """A sphere that MuJoCo keeps out of the ground; gives a sensor of its force on the ground, in N."""
        # With the pyramidal cone the depth at rest would depend on friction: 1.6 to 100 mm for 0.5 to 2.
        self.spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        sphere = self._name("sphere")
        place.body.add_geom(
            name=sphere,
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            pos=list(place.position),
            size=[float(radius), 0, 0],
            mass=0,
            contype=0,
            conaffinity=1,
            priority=1,  # its numbers hold, not a mean of them with the ground's
            friction=[float(friction), 0.005, 0.0001],
            solref=[float(v) for v in solref],
            solimp=[float(v) for v in solimp],
            info=self._info,
        )
        sensor = self._sensor("touch", mujoco.mjtSensor.mjSENS_CONTACT, sphere, mujoco.mjtObj.mjOBJ_GEOM)
        made = self.spec.sensor(sensor.name)
        made.intprm = [1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE), 3, 1]  # the force alone, net of all contacts
        return sensor

    def touches(self, place: Point, radius: float = 0.0) -> None:
        """Tell that the ground carries the body here: a point, or a sphere of a radius in m."""
        self.touching.append(Touching(place.body.name, place.position, float(radius)))

    def stands_on(self, lift: Element) -> None:
        """Let this vertical joint put the lowest place that touches on the ground, unless `initial:` sets it."""
        self.lifts.append(lift.name)

    def begins_at(self, joint: Element, position: float, velocity: float) -> None:
        """Let a joint begin at a coordinate and a velocity of its own, in SI, unless `initial:` sets them."""
        self.begins.append((joint.name, float(position), float(velocity)))

    def position_of(self, place: Point, surface: str = "", suffix: str = "position") -> Element:
        """A sensor of where a place is in the world, or on the ground of an inner part: three numbers, in m."""
        sensor = self._sensor(suffix, mujoco.mjtSensor.mjSENS_FRAMEPOS, self._site(f"{suffix}.origin", place))
        if surface:
            made = self.spec.sensor(sensor.name)
            made.reftype, made.refname = mujoco.mjtObj.mjOBJ_SITE, self._name(f"{surface}.surface")
        return sensor

    def orientation_of(self, place: Point) -> tuple[Element, Element]:
        """Sensors of a place's own z axis in the world, and of its angular velocity there in rad/s."""
        site = self._site("axis", place)
        axis = self._sensor("direction", mujoco.mjtSensor.mjSENS_FRAMEZAXIS, site)
        return axis, self._sensor("angular_velocity", mujoco.mjtSensor.mjSENS_FRAMEANGVEL, site)

    def center_of_mass(self) -> tuple[Element, Element]:
        """Sensors of where the center of mass of all that moves is, in m, and of its velocity."""
        body = mujoco.mjtObj.mjOBJ_BODY
        position = self._sensor("position", mujoco.mjtSensor.mjSENS_SUBTREECOM, "world", body)
        return position, self._sensor("velocity", mujoco.mjtSensor.mjSENS_SUBTREELINVEL, "world", body)

    def _sensor(self, suffix: str, kind: Any, of: str, what: Any = mujoco.mjtObj.mjOBJ_SITE) -> Element:
        name = self._name(suffix)
        self.spec.add_sensor(name=name, type=kind, objtype=what, objname=of, info=self._info)
        return Element("sensor", name)

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
        actuator = self.spec.add_actuator(
            name=name, trntype=transmission, target=element.name, info=self._info
        )
        _drive(actuator, gain, limits)
        return Element("actuator", name)

    def read(self, port: str, element: Element, field_name: str, index: int = 0) -> None:
        """Let an output be a number of MuJoCo's data: qpos, ten_length, actuator_velocity, sensordata ..."""
        self.reads.append(tied(port, element, field_name, index))

    def read_energy(self, potential: str, kinetic: str) -> None:
        """Let two outputs be MuJoCo's potential and kinetic energy."""
        self.spec.option.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
        self.reads += [Tie(potential, None, "energy", 0), Tie(kinetic, None, "energy", 1)]

    def read_weight(self, port: str) -> None:
        """Let an output be the weight of everything that moves, in N."""
        self._read_constant(port, lambda model: -float(model.opt.gravity[2] * model.body_subtreemass[0]))

    def read_key(self, port: str) -> None:
        """Let an output be a whole number below 2^32 that this part's address gives.

        Two parts with one seed draw different numbers if they are keyed by it.
        """
        key = float(zlib.crc32(self.part.address.encode()))
        self._read_constant(port, lambda model: key)

    def _read_constant(self, port: str, of: Callable[[Any], float]) -> None:
        place = max(self.spec.nuserdata, 0)
        self.spec.nuserdata = place + 1
        self.reads.append(Tie(port, None, "userdata", place))
        self.constants.append(of)

    def apply(self, port: str, element: Element, field_name: str, sign: float = 1.0) -> None:
        """Write an input or output into MuJoCo's data: qfrc_applied of a joint, ctrl of an actuator."""
        self.applies.append(tied(port, element, field_name, 0, sign))

    def draw_sphere(self, position: Vector, radius: float) -> None:
        """A massless sphere to look at."""
        self._draw(
            type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=self._mirrored(position), size=[float(radius), 0, 0]
        )

    def draw_rod(self, start: Vector, end: Vector, radius: float) -> None:
        """A massless capsule to look at."""
        ends = [*self._mirrored(start), *self._mirrored(end)]
        self._draw(type=mujoco.mjtGeom.mjGEOM_CAPSULE, fromto=ends, size=[float(radius), 0, 0])

    def draw_line(self, points: Sequence[Point | Moved], radius: float) -> None:
        """A line to look at where there is no body, such as a massless leg; radius in m."""
        moved = tuple(place if isinstance(place, Moved) else Moved(place) for place in points)
        for way in (way for place in moved for way in (place.forward, place.up) if way is not None):
            self._check_output("draw_line", way[0])
        self.drawings.append(DrawnLine(moved, float(radius)))

    def moved(
        self, place: Point, forward: tuple[str, float] | None = None, up: tuple[str, float] | None = None
    ) -> Moved:
        """For `draw_line`: a place moved in the world by outputs in m, such as up=("length", -0.5)."""
        return Moved(place, forward, up)

    def draw_force(
        self, place: Point, up: str | None = None, forward: str | None = None, surface: str = ""
    ) -> None:
        """An arrow to look at: the force on a place, from outputs in N along axes as `push` has them."""
        for port in (port for port in (up, forward) if port is not None):
            self._check_output("draw_force", port)
        site = self._name(f"{surface}.surface") if surface else ""
        self.drawings.append(DrawnForce(place, forward, up, site))

    def _check_output(self, call: str, port: str) -> None:
        outputs = self.part.type.outputs
        if port not in outputs:
            hint = did_you_mean(port, outputs)
            raise ValueError(f"mj.{call} names {port}, which is declared as no output. {hint}")

    def _draw(self, **shape: Any) -> None:
        if self.dressed:
            self.own_body.add_geom(**self._massless, **shape)

    @property
    def _massless(self) -> dict[str, Any]:
        return {"contype": 0, "conaffinity": 0, "mass": 0, "info": self._info}


def _drive(actuator: Any, gain: Vector, limits: Vector | None) -> None:
    """Set how an actuator's force follows from its control; see `Mechanics.motor`."""
    actuator.set_to_motor()
    if gain[1]:
        actuator.gaintype = mujoco.mjtGain.mjGAIN_AFFINE
        actuator.gainprm[:3] = [float(gain[0]), 0, float(gain[1])]
    else:
        actuator.gainprm[0] = float(gain[0])
    if limits is not None:
        actuator.forcelimited, actuator.forcerange = True, [float(limit) for limit in limits]


def numbers_of(part: Part, values: Sequence[float], frames: Frames) -> SimpleNamespace:
    """The `p` of a part's `build`: parameters, options, recorded curves, and points on their bodies."""
    numbers = {name: values[index] for name, index in part.numbers.items()}
    points = {
        name: [
            frames.point(place.frame, _mirrored_point([values[i] for i in place.at], part.mirrored))
            for place in places
        ]
        for name, places in part.points.items()
    }
    series = {name: recording.values for name, recording in part.series.items()}
    return SimpleNamespace(**numbers, **part.options, **points, **series)


def _mirrored_point(at: Vector, mirrored: bool) -> Vector:
    return (at[0], -at[1], at[2]) if mirrored else at
