"""What all verbs of mechanics share: the part that they work for, and the collected results."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from gaitsim.compiler.mechanics.places import DrawnForce, DrawnLine, Frames, Lift, Point, Relief, Touching, Vector
from gaitsim.compiler.mechanics.ties import Tie
from gaitsim.component import Refused
from gaitsim.model import Part


@dataclass
class Made:
    """What parts make besides MuJoCo's elements. Ties and drawings have the index of their part."""

    reads: list[tuple[int, Tie]] = field(default_factory=list)
    applies: list[tuple[int, Tie]] = field(default_factory=list)
    resets: list[tuple[int, Tie]] = field(default_factory=list)
    constants: list[Callable[[Any], float]] = field(default_factory=list)
    drawings: list[tuple[int, DrawnLine | DrawnForce]] = field(default_factory=list)
    touching: list[Touching] = field(default_factory=list)
    carried: dict[int, str] = field(default_factory=dict)  # parts that touch the ground: the body they are on
    planar: list[int] = field(default_factory=list)  # segments whose inertia is known about the transverse axis only
    slopes: dict[str, tuple[float, float]] = field(default_factory=dict)  # of grounds by the sites of their surfaces
    reliefs: dict[str, Relief] = field(default_factory=dict)  # uneven ground by the site of its surface
    later: list[Callable[[], None]] = field(default_factory=list)  # what is made once all parts were built
    collided: list[int] = field(default_factory=list)  # parts that MuJoCo keeps out of the ground
    pushed: dict[int, list[Vector]] = field(default_factory=dict)  # axes along which parts push
    lifts: list[Lift] = field(default_factory=list)
    begins: list[tuple[str, float, float]] = field(default_factory=list)
    agreed: dict[str, tuple[str, float]] = field(default_factory=dict)  # what one part said first, and how much


@dataclass
class Making:
    """The verbs of one part. The elements have the address of the part and its place in the spec.

    Positions are in the frame of the part's own body: x forwards, y to the left, z up. Values for the right side are
    mirrored in y for the left side.
    """

    spec: Any
    part: Part
    frames: Frames
    made: Made
    index: int
    dressed: bool = True
    own_body: Any = None
    beside: Mapping[str, Vector] = field(default_factory=dict)  # how far attachments are from their frames

    @property
    def _info(self) -> str:
        return str(self.part.mark)

    def _name(self, suffix: str) -> str:
        return f"{self.part.address}.{suffix}" if suffix else self.part.address

    def _mirrored(self, vector: Vector) -> tuple[float, float, float]:
        x, y, z = (float(v) for v in vector)
        return (x, -y if self.part.mirrored else y, z)

    def attached(self, name: str, offset: Vector = (0, 0, 0)) -> Point:
        """The place of an attachment of the part, with an offset in m."""
        at = self.frames.point(self.part.attachments[name], self.beside.get(name, (0, 0, 0)))
        return Point(at.body, _sum(at.position, self._mirrored(offset)))

    def agree(self, what: str, value: float, unit: str, reason: str) -> None:
        """Refuse a value that differs from what another part of the model gave for the same thing."""
        other, first = self.made.agreed.setdefault(what, (self.part.address, value))
        if value != first:
            raise Refused(f"{what} is {value:g} {unit} here but {first:g} {unit} in {other}; {reason}")

    def _site(self, suffix: str, point: Point, radius: float = 0.005) -> str:
        name = self._name(suffix)
        point.body.add_site(name=name, pos=list(point.position), size=[radius] * 3, info=self._info)
        return name

    @property
    def _massless(self) -> dict[str, Any]:
        return {"contype": 0, "conaffinity": 0, "mass": 0, "info": self._info}


def _sum(first: Vector, second: Vector) -> tuple[float, float, float]:
    x, y, z = (a + b for a, b in zip(first, second, strict=True))
    return x, y, z
