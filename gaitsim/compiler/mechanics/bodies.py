"""Bodies: their mass, and the frames on them."""

from __future__ import annotations

from gaitsim.compiler.mechanics.making import Making
from gaitsim.compiler.mechanics.places import Point, Vector


class Bodies(Making):
    """Verbs that shape the part's own body."""

    def body(self, mass: float, center_of_mass: Vector, inertia: Vector) -> None:
        """Mass in kg, center of mass in m, principal moments of inertia there in kg m^2."""
        self.own_body.mass = float(mass)
        self.own_body.ipos = self._mirrored(center_of_mass)
        self.own_body.inertia = [float(i) for i in inertia]
        self.own_body.explicitinertial = True

    def frame(self, name: str, position: Vector) -> None:
        """Where a declared frame lies on the part's own body, in m."""
        self.frames.places[self._name(name)] = Point(self.own_body, self._mirrored(position))
