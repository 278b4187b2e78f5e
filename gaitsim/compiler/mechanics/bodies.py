"""Bodies: their mass, and the frames on them."""

from __future__ import annotations

from gaitsim.compiler.mechanics.making import Making
from gaitsim.compiler.mechanics.places import Point, Vector
from gaitsim.component import Refused

_ROUNDING = 1e-9


class Bodies(Making):
    """Verbs for the part's own body."""

    def body(self, mass: float, center_of_mass: Vector, inertia: Vector, planar: bool = False) -> None:
        """Set the mass properties of the body.

        Args:
            mass: In kg.
            center_of_mass: In m.
            inertia: Principal moments of inertia about the center of mass, in kg m^2.
            planar: Whether only the second of them is known, so that the body may turn in the sagittal plane only.

        Raises:
            Refused: One moment of inertia is larger than the two others together.
        """
        largest = max(inertia)
        others = sum(inertia) - largest
        if largest > others * (1 + _ROUNDING):
            rule = (
                f"a moment of inertia is at most the sum of the two others, and {largest:g} kg m^2 is above {others:g}"
            )
            raise Refused(f"{rule} kg m^2; correct its inertias about the three axes")
        if planar:
            self.made.planar.append(self.index)
        self.own_body.mass = float(mass)
        self.own_body.ipos = self._mirrored(center_of_mass)
        self.own_body.inertia = [float(i) for i in inertia]
        self.own_body.explicitinertial = True

    def frame(self, name: str, position: Vector) -> None:
        """Set the position of a declared frame on the body, in m."""
        self.frames.places[self._name(name)] = Point(self.own_body, self._mirrored(position))
