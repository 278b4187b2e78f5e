from gaitsim.component import Component, Frame, Parameter


class Rod(Component):
    """A rigid segment that hangs from its proximal end along -z; its length is along the rod."""

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
    proximal = Frame("The upper end.")
    distal = Frame("The lower end.")
    center = Frame("The center of mass.")

    @staticmethod
    def build(p, mj):
        center = (0, 0, -p.center_of_mass * p.length)
        transverse = p.mass * (p.radius_of_gyration * p.length) ** 2
        along = 0.5 * p.mass * p.thickness**2
        mj.body(mass=p.mass, center_of_mass=center, inertia=(transverse, transverse, along))
        mj.frame("proximal", (0, 0, 0))
        mj.frame("distal", (0, 0, -p.length))
        mj.frame("center", center)
        mj.draw_rod((0, 0, 0), (0, 0, -p.length), p.thickness)
