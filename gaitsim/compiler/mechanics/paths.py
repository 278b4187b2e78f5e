"""Paths: tendons through points and around cylinders."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import mujoco
import numpy as np

from gaitsim.compiler.mechanics.making import Making
from gaitsim.compiler.mechanics.places import Point, Vector, Wrap
from gaitsim.compiler.mechanics.ties import Element
from gaitsim.component import Refused


class Paths(Making):
    """Verbs for tendons."""

    def tendon(self, places: Sequence[Point | Wrap], suffix: str = "") -> Element:
        """Add a tendon through points and around cylinders, straight between them.

        Raises:
            Refused: There are fewer than two points, all lie on one body, or two that follow each other coincide.
        """
        _check(places)
        tendon = self.spec.add_tendon(name=self._name(suffix), info=self._info)
        for i, place in enumerate(places):
            if isinstance(place, Wrap):
                tendon.wrap_geom(place.geom, place.side)
            else:
                tendon.wrap_site(self._site(f"{suffix}.points.{i}".lstrip("."), place))
        return Element("tendon", self._name(suffix))

    def tendon_between(self, first: str, second: str) -> Element:
        """Add a straight tendon between two attachments of the part."""
        return self.tendon([self.attached(name) for name in (first, second)])

    def cylinder(self, center: Point, radius: float, side: Point, axis: Vector = (0, 1, 0)) -> Wrap:
        """Add a massless cylinder around which tendons wrap.

        Args:
            center: Its center.
            radius: In m.
            side: The place on whose side tendons pass.
            axis: Its axis.
        """
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
        """Keep two tendons equally long, by one critically damped equality constraint of MuJoCo."""
        equality = self.spec.add_equality(
            name=self._name("equality"),
            type=mujoco.mjtEq.mjEQ_TENDON,
            name1=first.name,
            name2=second.name,
            solref=[float(time_constant), 1],
            solimp=[float(impedance), float(impedance), 0.001, 0.5, 2],
            info=self._info,
        )
        # MuJoCo measures from the lengths at which all coordinates are 0.
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


def _check(places: Sequence[Point | Wrap]) -> None:
    points = [place for place in places if isinstance(place, Point)]
    if len(points) < 2:
        raise Refused(f"a path runs through two points at least, and this has {len(points)}; write where it ends")
    bodies = {point.body.name for point in points}
    if len(bodies) == 1:
        rule = f"all of its points lie on {bodies.pop()}, so its length never changes"
        raise Refused(f"{rule}; put the points beyond a joint on the segment there")
    for number, (one, two) in enumerate(itertools.pairwise(places), start=1):
        if isinstance(one, Point) and isinstance(two, Point) and one == two:
            raise Refused(
                f"points {number} and {number + 1} are at the same place of {one.body.name}; remove one of them"
            )
