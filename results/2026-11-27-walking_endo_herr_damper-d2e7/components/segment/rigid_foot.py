from gaitsim.component import Component, Frame, Parameter


class RigidFoot(Component):
    """A foot with a flat sole from heel to ball; at angle 0 it lies flat, with the ball in front.

    The origin is the ankle. Everything else is measured along the sole, from the heel.
    """

    mass = Parameter("kg", "Mass.", bounds=(1e-6, 1000))
    inertia = Parameter(
        "kg m^2", "Moment of inertia about a transverse axis through the center of mass.", bounds=(1e-9, 1000)
    )
    length = Parameter("m", "Length from the heel to the ball.", bounds=(1e-3, 10))
    ankle = Parameter("m", "Distance of the ankle in front of the heel.", bounds=(-1, 1))
    ankle_height = Parameter("m", "Height of the ankle above the sole.", default=0, bounds=(0, 1), source="geyer2010")
    center_of_mass = Parameter("m", "Distance of the center of mass in front of the heel.", bounds=(-1, 1))
    center_height = Parameter(
        "m", "Height of the center of mass above the sole.", default=0, bounds=(0, 1), source="geyer2010"
    )
    thickness = Parameter(
        "m",
        "Radius of the drawn shape.",
        default=0.02,
        bounds=(1e-4, 1),
        source="definition: for drawings only; no mass follows from it",
    )
    proximal = Frame("The ankle, as with other segments.")
    distal = Frame("The ball, as with other segments.")
    ball = Frame("The front end of the sole.")
    heel = Frame("The hind end of the sole.")
    center = Frame("The center of mass.")

    @staticmethod
    def build(p, mj):
        heel = (-p.ankle, 0, -p.ankle_height)
        ball = (p.length - p.ankle, 0, -p.ankle_height)
        center = (p.center_of_mass - p.ankle, 0, p.center_height - p.ankle_height)
        # About all three axes: only the transverse one matters in a plane.
        mj.body(mass=p.mass, center_of_mass=center, inertia=(p.inertia, p.inertia, p.inertia), planar=True)
        mj.frame("proximal", (0, 0, 0))
        mj.frame("distal", ball)
        mj.frame("ball", ball)
        mj.frame("heel", heel)
        mj.frame("center", center)
        mj.draw_rod(heel, ball, p.thickness)
