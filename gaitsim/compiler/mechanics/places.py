"""Places on bodies of the MuJoCo model, and drawings at them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from gaitsim.model import WORLD

Vector = Sequence[float]


@dataclass(frozen=True)
class Point:
    """A place on a body of the MuJoCo model, for verbs such as `mj.tendon`."""

    body: Any
    position: tuple[float, float, float]


@dataclass(frozen=True)
class Wrap:
    """A cylinder around which a path wraps, on the side of a site; made by `mj.cylinder`."""

    geom: str
    side: str


@dataclass(frozen=True)
class Touching:
    """A place on a named body that the ground carries: a point, or a sphere with a radius in m."""

    body: str
    position: tuple[float, float, float]
    radius: float


@dataclass(frozen=True)
class Lift:
    """A vertical joint that starts where the ground carries a load.

    Attributes:
        part: The index of its part.
        joint: Its name in MuJoCo.
        load: The load in body weights; with 0, the lowest contact just touches the ground.
    """

    part: int
    joint: str
    load: float


@dataclass(frozen=True)
class Relief:
    """Ground whose height varies from place to place, above a level plane.

    Attributes:
        surface: The function of its numbers and of a place, forwards and to the left in m. Its results are the height
            in m, and how much it grows in either direction.
        numbers: The first arguments of that function.
    """

    surface: Callable[..., Sequence[float]]
    numbers: tuple[float, ...]

    def at(self, forward: float, left: float) -> tuple[float, float, float]:
        """The height at a place in m, and how much it grows forwards and to the left."""
        height, rise, side_rise = self.surface(*self.numbers, forward, left)
        return height, rise, side_rise


@dataclass(frozen=True)
class Moved:
    """A place that outputs move forwards and upwards in the world, in m. Each direction has an output and a factor."""

    place: Point
    forward: tuple[str, float] | None = None
    up: tuple[str, float] | None = None


@dataclass(frozen=True)
class DrawnLine:
    """A drawn line through places that outputs may move; radius in m."""

    points: tuple[Moved, ...]
    radius: float


@dataclass(frozen=True)
class DrawnForce:
    """A drawn arrow: the force on a place, from outputs in N forwards, upwards and to the left.

    Attributes:
        surface: The site whose axes are used; empty for the axes of the world.
    """

    place: Point
    forward: str | None
    up: str | None
    surface: str = ""
    left: str | None = None


@dataclass
class Frames:
    """The body and the position of every frame of the model."""

    places: dict[str, Point] = field(default_factory=dict)

    def point(self, frame: str, offset: Vector = (0, 0, 0)) -> Point:
        place = self.places[frame]
        x, y, z = (a + b for a, b in zip(place.position, offset, strict=True))
        return Point(place.body, (x, y, z))


def world_frames(spec: Any) -> Frames:
    """The frames of the world: the ground."""
    return Frames({WORLD: Point(spec.worldbody, (0.0, 0.0, 0.0))})
