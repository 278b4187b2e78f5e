from gaitsim.component import Component, Frame, Option, Parameter


class Rod(Component):
    """A rigid segment along a line; by default it hangs from its proximal end."""

    mass = Parameter("kg", "Mass.", bounds=(1e-6, 1000))
    length = Parameter("m", "Length from the proximal to the distal end.", bounds=(1e-3, 10))
    center_of_mass = Parameter(
        "1",
        "Distance of the center of mass from the proximal end, as a fraction of the length.",
        default=0.5,
        bounds=(0, 1),
        source="definition: uniform rod",
    )
    radius_of_gyration = Parameter(
        "1",
        "Radius of gyration about a transverse axis through the center of mass, as a fraction of the length.",
        default=0.28867513459481287,
        bounds=(1e-3, 1),
        source="definition: uniform rod, 1/sqrt(12)",
    )
    thickness = Parameter(
        "m",
        "Radius of the cylinder that is drawn and that gives the inertia about the long axis, m r^2 / 2.",
        default=0.04,
        bounds=(1e-4, 1),
        source="definition: solid cylinder; irrelevant to motion in a plane",
    )
    direction = Option("From the proximal to the distal end.", choices=("down", "up", "forward"), default="down")
    proximal = Frame("The end at the origin.")
    distal = Frame("The other end.")
    center = Frame("The center of mass.")

    @staticmethod
    def build(p, mj):
        x, z = {"down": (0, -1), "up": (0, 1), "forward": (1, 0)}[p.direction]
        end = (x * p.length, 0, z * p.length)
        center = (p.center_of_mass * end[0], 0, p.center_of_mass * end[2])
        transverse = p.mass * (p.radius_of_gyration * p.length) ** 2
        along = 0.5 * p.mass * p.thickness**2
        inertia = (along, transverse, transverse) if x else (transverse, transverse, along)
        mj.body(mass=p.mass, center_of_mass=center, inertia=inertia)
        mj.frame("proximal", (0, 0, 0))
        mj.frame("distal", end)
        mj.frame("center", center)
        mj.draw_rod((0, 0, 0), end, p.thickness)
