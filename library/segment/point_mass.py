from gaitsim.component import Component, Frame, Parameter


class PointMass(Component):
    """A point mass, with the inertia of a small sphere so that it may rotate."""

    mass = Parameter("kg", "Mass.", bounds=(1e-6, 1000))
    radius = Parameter(
        "m",
        "Radius of the sphere that is drawn and that gives the inertia, 2/5 m r^2.",
        default=0.1,
        bounds=(1e-4, 1),
        source="definition: solid sphere; irrelevant to translation",
    )
    center = Frame("The point.")

    @staticmethod
    def build(p, mj):
        inertia = 0.4 * p.mass * p.radius**2
        mj.body(mass=p.mass, center_of_mass=(0, 0, 0), inertia=(inertia, inertia, inertia))
        mj.frame("center", (0, 0, 0))
        mj.draw_sphere((0, 0, 0), p.radius)
