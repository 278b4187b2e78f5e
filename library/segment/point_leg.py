from gaitsim.component import Component, Frame, Option, Parameter


class PointLeg(Component):
    """A massless straight leg with one point mass on it, and one at its distal end, such as the hip."""

    mass = Parameter("kg", "Mass of the point.", bounds=(1e-9, 1000))
    position = Parameter("m", "Its distance from the proximal end.", bounds=(0, 10))
    end_mass = Parameter(
        "kg", "Mass at the distal end.", default=0, bounds=(0, 1000), source="definition: a point on a massless rod"
    )
    length = Parameter("m", "Length.", bounds=(1e-3, 10))
    thickness = Parameter(
        "m",
        "Radius of the drawn shape.",
        default=0.02,
        bounds=(1e-4, 1),
        source="definition: for drawings only; no mass follows from it",
    )
    direction = Option("From the proximal to the distal end.", choices=("down", "up"), default="down")
    proximal = Frame("The end at the origin.")
    distal = Frame("The other end.")

    @staticmethod
    def build(p, mj):
        sign = 1 if p.direction == "up" else -1
        whole = p.mass + p.end_mass
        center = (p.mass * p.position + p.end_mass * p.length) / whole
        # MuJoCo requires an inertia, which a point lacks: 1e-8 of that of the leg about its end.
        inertia = p.mass * p.end_mass / whole * (p.length - p.position) ** 2 + 1e-8 * p.mass * p.length**2
        mj.body(mass=whole, center_of_mass=(0, 0, sign * center), inertia=(inertia, inertia, inertia))
        mj.frame("proximal", (0, 0, 0))
        mj.frame("distal", (0, 0, sign * p.length))
        mj.draw_rod((0, 0, 0), (0, 0, sign * p.length), p.thickness)
        mj.draw_sphere((0, 0, sign * p.position), 2 * p.thickness)
        if p.end_mass > 0:
            mj.draw_sphere((0, 0, sign * p.length), 4 * p.thickness)
