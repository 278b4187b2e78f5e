from gaitsim.component import Component, Frame, Parameter


class Pelvis(Component):
    """A block with a hip on either side: a user's own component, beside the spec."""

    mass = Parameter("kg", "Mass.", bounds=(1e-3, 100))
    width = Parameter("cm", "Distance between the hips.", default=20, bounds=(1, 100), source="definition: a test")
    top = Frame("Its middle.")
    hip_r = Frame("The right hip.")
    hip_l = Frame("The left hip.")

    @staticmethod
    def build(p, mj):
        mj.body(mass=p.mass, center_of_mass=(0, 0, 0), inertia=(0.1, 0.1, 0.1))
        mj.frame("top", (0, 0, 0))
        mj.frame("hip_r", (0, -p.width / 2, 0))
        mj.frame("hip_l", (0, p.width / 2, 0))
