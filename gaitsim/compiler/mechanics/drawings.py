"""Drawings, which only films show."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mujoco

from gaitsim.compiler.mechanics.making import Making
from gaitsim.compiler.mechanics.places import DrawnForce, DrawnLine, Moved, Point, Vector
from gaitsim.errors import did_you_mean


class Drawings(Making):
    """Verbs that draw. None changes the mechanics."""

    def draw_sphere(self, position: Vector, radius: float) -> None:
        """Draw a sphere without mass."""
        self._draw(type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=self._mirrored(position), size=[float(radius), 0, 0])

    def draw_rod(self, start: Vector, end: Vector, radius: float) -> None:
        """Draw a capsule without mass."""
        ends = [*self._mirrored(start), *self._mirrored(end)]
        self._draw(type=mujoco.mjtGeom.mjGEOM_CAPSULE, fromto=ends, size=[float(radius), 0, 0])

    def draw_line(self, points: Sequence[Point | Moved], radius: float) -> None:
        """Draw a line where there is no body, such as a massless leg; radius in m."""
        moved = tuple(place if isinstance(place, Moved) else Moved(place) for place in points)
        for way in (way for place in moved for way in (place.forward, place.up) if way is not None):
            self._check_output("draw_line", way[0])
        self.made.drawings.append((self.index, DrawnLine(moved, float(radius))))

    def moved(
        self, place: Point, forward: tuple[str, float] | None = None, up: tuple[str, float] | None = None
    ) -> Moved:
        """A place for `draw_line` that outputs in m move in the world, such as up=("length", -0.5)."""
        return Moved(place, forward, up)

    def draw_force(
        self,
        place: Point,
        up: str | None = None,
        forward: str | None = None,
        surface: str = "",
        left: str | None = None,
    ) -> None:
        """Draw the force on a place as an arrow.

        Args:
            place: The place.
            up: The output with the upward component, in N.
            forward: The output with the forward component, in N.
            surface: The inner part whose ground gives the axes, as for `push`.
            left: The output with the component to the left, in N.
        """
        for port in (port for port in (up, forward, left) if port is not None):
            self._check_output("draw_force", port)
        site = self._name(f"{surface}.surface") if surface else ""
        self.made.drawings.append((self.index, DrawnForce(place, forward, up, site, left)))

    def _check_output(self, call: str, port: str) -> None:
        outputs = self.part.type.outputs
        if port not in outputs:
            hint = did_you_mean(port, outputs)
            raise ValueError(f"mj.{call} names {port}, which is declared as no output. {hint}")

    def _draw(self, **shape: Any) -> None:
        if self.dressed:
            self.own_body.add_geom(**self._massless, **shape)
