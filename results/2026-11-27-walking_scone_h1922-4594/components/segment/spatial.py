from gaitsim.component import Component, Frame, Parameter


class Spatial(Component):
    """A rigid segment in space. Coordinates are from its center of mass: forwards, to the left, upwards.

    These are its principal axes of inertia. Joints attach to the proximal and the distal end, or to a place given
    relative to a frame: `parent: {on: pelvis.center, at: [0 cm, -8 cm, -7 cm]}`. On the left side
    (`sides: [l, r]`), coordinates of the right segment are mirrored.
    """

    mass = Parameter("kg", "Mass.", bounds=(1e-6, 1000))
    inertia_forward = Parameter(
        "kg m^2", "Moment of inertia about the forward axis through the center of mass.", bounds=(1e-9, 1000)
    )
    inertia_left = Parameter(
        "kg m^2", "Moment of inertia about the axis to the left through the center of mass.", bounds=(1e-9, 1000)
    )
    inertia_up = Parameter(
        "kg m^2", "Moment of inertia about the upward axis through the center of mass.", bounds=(1e-9, 1000)
    )
    proximal_forward = Parameter(
        "m", "Proximal end, forwards.", default=0, bounds=(-10, 10), source="definition: in line with the center"
    )
    proximal_left = Parameter(
        "m", "Proximal end, to the left.", default=0, bounds=(-10, 10), source="definition: in line with the center"
    )
    proximal_up = Parameter(
        "m", "Proximal end, upwards.", default=0, bounds=(-10, 10), source="definition: in the center"
    )
    distal_forward = Parameter(
        "m", "Distal end, forwards.", default=0, bounds=(-10, 10), source="definition: in line with the center"
    )
    distal_left = Parameter(
        "m", "Distal end, to the left.", default=0, bounds=(-10, 10), source="definition: in line with the center"
    )
    distal_up = Parameter("m", "Distal end, upwards.", default=0, bounds=(-10, 10), source="definition: in the center")
    thickness = Parameter(
        "m",
        "Radius of the cylinder that is drawn from end to end.",
        default=0.04,
        bounds=(1e-4, 1),
        source="definition: for drawings only; no mass follows from it",
    )
    center = Frame("The center of mass.")
    proximal = Frame("The end near the trunk.")
    distal = Frame("The other end.")

    @staticmethod
    def build(p, mj):
        proximal = (p.proximal_forward, p.proximal_left, p.proximal_up)
        distal = (p.distal_forward, p.distal_left, p.distal_up)
        mj.body(mass=p.mass, center_of_mass=(0, 0, 0), inertia=(p.inertia_forward, p.inertia_left, p.inertia_up))
        mj.frame("center", (0, 0, 0))
        mj.frame("proximal", proximal)
        mj.frame("distal", distal)
        if proximal != distal:
            mj.draw_rod(proximal, distal, p.thickness)
        else:
            mj.draw_sphere(proximal, p.thickness)
