"""What a component's `build(p, mj)` works on: bodies, joints, tendons and their ties to ports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import mujoco

from gaitsim.model import WORLD, Part

Vector = Sequence[float]


@dataclass(frozen=True)
class Element:
    """A named element of the MuJoCo model: a joint, tendon, actuator or sensor."""

    kind: str
    name: str


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

    def hinge(self, axis: Vector, suffix: str = "", damping: float = 0.0) -> Element:
        """A rotation of the child about an axis; damping in N m s/rad."""
        x, y, z = (float(v) for v in axis)
        # An axis is a pseudovector: mirrored in y, its x and z turn round and its y stays.
        turned = (-x, y, -z) if self.part.mirrored else (x, y, z)
        return self._joint(mujoco.mjtJoint.mjJNT_HINGE, turned, suffix, damping)

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

    def tendon(self, points: Sequence[Point]) -> Element:
        """A straight tendon through points."""
        tendon = self.spec.add_tendon(name=self.part.address, info=self._info)
        for i, point in enumerate(points):
            name = self._name(f"points.{i}")
            point.body.add_site(name=name, pos=list(point.position), size=[0.005] * 3, info=self._info)
            tendon.wrap_site(name)
        return Element("tendon", self.part.address)

    def tendon_between(self, first: str, second: str) -> Element:
        """A straight tendon between two of the part's attachments."""
        frames = [self.frames.point(self.part.attachments[name]) for name in (first, second)]
        return self.tendon(frames)

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
        """Let an output be a number of MuJoCo's data: qpos, qvel, ten_length, ten_velocity, sensordata."""
        self.reads.append(Tie(port, element, field_name, index))

    def read_energy(self, potential: str, kinetic: str) -> None:
        """Let two outputs be MuJoCo's potential and kinetic energy."""
        self.spec.option.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
        self.reads += [Tie(potential, None, "energy", 0), Tie(kinetic, None, "energy", 1)]

    def apply(self, port: str, element: Element, field_name: str, sign: float = 1.0) -> None:
        """Write an input or output into MuJoCo's data: qfrc_applied of a joint, ctrl of an actuator."""
        self.applies.append(Tie(port, element, field_name, 0, sign))

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
        self.own_body.add_geom(contype=0, conaffinity=0, mass=0, info=self._info, **shape)


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
