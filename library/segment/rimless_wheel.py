import math

from gaitsim.component import Component, Frame, Parameter


class RimlessWheel(Component):
    """A rimless wheel: a hub with massless spokes, one of which stands on the ground (McGeer 1990)."""

    mass = Parameter("kg", "Mass, at the hub.", bounds=(1e-6, 1000))
    inertia = Parameter("kg m^2", "Moment of inertia about the hub.", bounds=(0, 1000))
    spokes = Parameter("1", "Number of spokes.", bounds=(3, 100), whole=True)
    length = Parameter("m", "Length of a spoke.", bounds=(1e-3, 10))
    foot = Frame("The end of the standing spoke, the origin.")
    hub = Frame("The hub.")

    @staticmethod
    def build(p, mj):
        # MuJoCo requires an inertia, which a point lacks.
        inertia = max(p.inertia, 1e-12 * p.mass * p.length**2)
        mj.body(mass=p.mass, center_of_mass=(0, 0, p.length), inertia=(inertia, inertia, inertia))
        mj.frame("foot", (0, 0, 0))
        mj.frame("hub", (0, 0, p.length))
        mj.draw_sphere((0, 0, p.length), 0.08 * p.length)
        for spoke in range(round(p.spokes)):
            angle = 2 * math.pi * spoke / p.spokes
            end = (-p.length * math.sin(angle), 0, p.length - p.length * math.cos(angle))
            mj.draw_rod((0, 0, p.length), end, 0.02 * p.length)
