from gaitsim.component import Component, Frame, Option, Parameter


class Rigid(Component):
    """A rigid segment, given by mass, length, center of mass and moment of inertia."""

    mass = Parameter("kg", "Mass.", bounds=(1e-6, 1000))
    length = Parameter("m", "Length from the proximal to the distal end.", bounds=(1e-3, 10))
    center_of_mass = Parameter("m", "Distance of the center of mass from the proximal end.", bounds=(0, 10))
    inertia = Parameter(
        "kg m^2", "Moment of inertia about a transverse axis through the center of mass.", bounds=(1e-9, 1000)
    )
    thickness = Parameter(
        "m",
        "Radius of the drawn shape.",
        default=0.04,
        bounds=(1e-4, 1),
        source="definition: for drawings only; no mass follows from it",
    )
    direction = Option("From the proximal to the distal end.", choices=("down", "up", "forward"), default="down")
    proximal = Frame("The end at the origin.")
    distal = Frame("The other end.")
    center = Frame("The center of mass.")

    @staticmethod
    def build(p, mj):
        x, z = {"down": (0, -1), "up": (0, 1), "forward": (1, 0)}[p.direction]
        end = (x * p.length, 0, z * p.length)
        center = (x * p.center_of_mass, 0, z * p.center_of_mass)
        # About all three axes: only the transverse one matters in a plane.
        mj.body(mass=p.mass, center_of_mass=center, inertia=(p.inertia, p.inertia, p.inertia), planar=True)
        mj.frame("proximal", (0, 0, 0))
        mj.frame("distal", end)
        mj.frame("center", center)
        mj.draw_rod((0, 0, 0), end, p.thickness)
