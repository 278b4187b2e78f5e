"""What a component's `build(p, mj)` works on: bodies, joints, tendons and their ties to ports."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np

from gaitsim.errors import did_you_mean, with_article
from gaitsim.model import WORLD, Part

Vector = Sequence[float]


@dataclass(frozen=True)
class Element:
    """A named element of the MuJoCo model: a joint, tendon, actuator, sensor or site."""

    kind: str
    name: str


# What MuJoCo's data holds of each kind of element.
_FIELDS = {
    "joint": ("qpos", "qvel", "qacc", "qfrc_applied"),
    "tendon": ("ten_length", "ten_velocity"),
    "actuator": ("ctrl", "actuator_length", "actuator_velocity", "actuator_force"),
    "sensor": ("sensordata",),
}


@dataclass(frozen=True)
class Tie:
    """A port tied to one number of MuJoCo's data, such as qpos of a joint."""

    port: str
    element: Element | None
    field: str
    index: int = 0
    sign: float = 1.0


@dataclass(frozen=True)
class Point:
    """A place on a body of the MuJoCo model, for `mj.tendon` and the like."""

    body: Any
    position: tuple[float, float, float]


@dataclass(frozen=True)
class Wrap:
    """A cylinder that a path bends around, on the side of a site; made by `mj.cylinder`."""

    geom: str
    side: str


@dataclass
class Frames:
    """Where every frame of the model lies: its body and its position there."""

    places: dict[str, Point] = field(default_factory=dict)

    def point(self, frame: str, offset: Vector = (0, 0, 0)) -> Point:
        place = self.places[frame]
        x, y, z = (a + b for a, b in zip(place.position, offset, strict=True))
        return Point(place.body, (x, y, z))


@dataclass
class Mechanics:
    """The MuJoCo side of one part: everything it makes bears its address and its place in the spec.

    Positions are in the frame of the part's own body: x forwards, y to the left, z up. What is
    written for the right side is mirrored in y for the left.
    """

    spec: Any
    part: Part
    frames: Frames
    own_body: Any = None
    reads: list[Tie] = field(default_factory=list)
    applies: list[Tie] = field(default_factory=list)
    constants: list[Callable[[Any], float]] = field(default_factory=list)

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
        self, axis: Vector, suffix: str = "", damping: float = 0.0, limits: Sequence[float] | None = None
    ) -> Element:
        """A rotation of the child about an axis; damping in N m s/rad.

        Limits in rad are told to whoever plots the joint; what happens there is the part's own.
        """
        x, y, z = (float(v) for v in axis)
        # An axis is a pseudovector: mirrored in y, its x and z turn round and its y stays.
        turned = (-x, y, -z) if self.part.mirrored else (x, y, z)
        joint = self._joint(mujoco.mjtJoint.mjJNT_HINGE, turned, suffix, damping)
        if limits is not None:
            made = self.spec.joint(joint.name)
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

    def push(self, place: Point, axis: Vector) -> Element:
        """An actuator whose control is a force on a place along an axis of the world.

        Its actuator_length is the place's coordinate on that axis, its actuator_velocity the rate.
        """
        name, ground = self._name("push"), "world.origin"
        if all(site.name != ground for site in self.spec.sites):
            self.spec.worldbody.add_site(name=ground, size=[0.005] * 3)
        actuator = self.spec.add_actuator(
            name=name,
            trntype=mujoco.mjtTrn.mjTRN_SITE,
            target=self._site("place", place),
            refsite=ground,
            gear=[*(float(v) for v in axis), 0, 0, 0],
            info=self._info,
        )
        actuator.set_to_motor()
        return Element("actuator", name)

    def collide(self, place: Point, radius: float, friction: float, solref: Vector, solimp: Vector) -> Element:
        """A sphere that MuJoCo keeps out of the level ground at height 0; gives its touch sensor (N)."""
        ground = "world.ground"
        if all(geom.name != ground for geom in self.spec.geoms):
            plane = mujoco.mjtGeom.mjGEOM_PLANE
            self.spec.worldbody.add_geom(name=ground, type=plane, size=[10, 10, 0.1], contype=1, conaffinity=0)
        place.body.add_geom(
            name=self._name("sphere"),
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
        site = self._site("zone", place, radius=1.1 * float(radius))
        return self._sensor("touch", mujoco.mjtSensor.mjSENS_TOUCH, site)

    def position_of(self, place: Point) -> Element:
        """A sensor of where a place is in the world: three numbers, in m."""
        return self._sensor("position", mujoco.mjtSensor.mjSENS_FRAMEPOS, self._site("origin", place))

    def _sensor(self, suffix: str, kind: Any, site: str) -> Element:
        name = self._name(suffix)
        self.spec.add_sensor(name=name, type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=site, info=self._info)
        return Element("sensor", name)

    def motor(self, element: Element) -> Element:
        """An actuator whose control is a force along a tendon (positive lengthens) or at a joint."""
        name = self._name("motor")
        transmission = {
            "tendon": mujoco.mjtTrn.mjTRN_TENDON,
            "joint": mujoco.mjtTrn.mjTRN_JOINT,
        }[element.kind]
        actuator = self.spec.add_actuator(
            name=name, trntype=transmission, target=element.name, info=self._info
        )
        actuator.set_to_motor()
        return Element("actuator", name)

    def read(self, port: str, element: Element, field_name: str, index: int = 0) -> None:
        """Let an output be a number of MuJoCo's data: qpos, ten_length, actuator_velocity, sensordata ..."""
        self.reads.append(_tie(port, element, field_name, index))

    def read_energy(self, potential: str, kinetic: str) -> None:
        """Let two outputs be MuJoCo's potential and kinetic energy."""
        self.spec.option.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
        self.reads += [Tie(potential, None, "energy", 0), Tie(kinetic, None, "energy", 1)]

    def read_weight(self, port: str) -> None:
        """Let an output be the weight of everything that moves, in N."""
        place = max(self.spec.nuserdata, 0)
        self.spec.nuserdata = place + 1
        self.reads.append(Tie(port, None, "userdata", place))
        self.constants.append(lambda model: -float(model.opt.gravity[2] * model.body_subtreemass[0]))

    def apply(self, port: str, element: Element, field_name: str, sign: float = 1.0) -> None:
        """Write an input or output into MuJoCo's data: qfrc_applied of a joint, ctrl of an actuator."""
        self.applies.append(_tie(port, element, field_name, 0, sign))

    def draw_sphere(self, position: Vector, radius: float) -> None:
        """A massless sphere to look at."""
        self._draw(
            type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=self._mirrored(position), size=[float(radius), 0, 0]
        )

    def draw_rod(self, start: Vector, end: Vector, radius: float) -> None:
        """A massless capsule to look at."""
        ends = [*self._mirrored(start), *self._mirrored(end)]
        self._draw(type=mujoco.mjtGeom.mjGEOM_CAPSULE, fromto=ends, size=[float(radius), 0, 0])

    def _draw(self, **shape: Any) -> None:
        self.own_body.add_geom(**self._massless, **shape)

    @property
    def _massless(self) -> dict[str, Any]:
        return {"contype": 0, "conaffinity": 0, "mass": 0, "info": self._info}


def _tie(port: str, element: Element, field_name: str, index: int, sign: float = 1.0) -> Tie:
    """A port tied to a number that such an element has. Errors: ValueError."""
    known = _FIELDS.get(element.kind, ())
    if field_name not in known:
        raise ValueError(f"{with_article(element.kind)} has no {field_name}. {did_you_mean(field_name, known)}")
    return Tie(port, element, field_name, index, sign)


def numbers_of(part: Part, values: Sequence[float], frames: Frames) -> SimpleNamespace:
    """The `p` of a part's `build`: parameters, options, and points on their bodies."""
    numbers = {name: values[index] for name, index in part.numbers.items()}
    points = {
        name: [
            frames.point(place.frame, _mirrored_point([values[i] for i in place.at], part.mirrored))
            for place in places
        ]
        for name, places in part.points.items()
    }
    return SimpleNamespace(**numbers, **part.options, **points)


def _mirrored_point(at: Vector, mirrored: bool) -> Vector:
    return (at[0], -at[1], at[2]) if mirrored else at


def world_frames(spec: Any) -> Frames:
    """The frames that are there before any part: the ground."""
    return Frames({WORLD: Point(spec.worldbody, (0.0, 0.0, 0.0))})
