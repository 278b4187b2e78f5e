"""Places on bodies of the MuJoCo model, and what is drawn there beside the bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from gaitsim.model import WORLD

Vector = Sequence[float]


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


@dataclass(frozen=True)
class Touching:
    """A place on a named body that the ground carries: a point, or a sphere of a radius in m."""

    body: str
    position: tuple[float, float, float]
    radius: float


@dataclass(frozen=True)
class Moved:
    """A place that outputs move away from itself in the world: forwards and upwards, in m.

    Each way is an output and a factor.
    """

    place: Point
    forward: tuple[str, float] | None = None
    up: tuple[str, float] | None = None


@dataclass(frozen=True)
class DrawnLine:
    """A line to look at through places that outputs may move; radius in m."""

    points: tuple[Moved, ...]
    radius: float


@dataclass(frozen=True)
class DrawnForce:
    """An arrow to look at: the force on a place, given by outputs in N, forwards, upwards and to the left.

    Attributes:
        surface: The site whose axes these are; empty for those of the world.
    """

    place: Point
    forward: str | None
    up: str | None
    surface: str = ""
    left: str | None = None


@dataclass
class Frames:
    """Where every frame of the model lies: its body and its position there."""

    places: dict[str, Point] = field(default_factory=dict)

    def point(self, frame: str, offset: Vector = (0, 0, 0)) -> Point:
        place = self.places[frame]
        x, y, z = (a + b for a, b in zip(place.position, offset, strict=True))
        return Point(place.body, (x, y, z))


def world_frames(spec: Any) -> Frames:
    """The frames that are there before any part: the ground."""
    return Frames({WORLD: Point(spec.worldbody, (0.0, 0.0, 0.0))})
