from gaitsim.component import Component, Frame, Parameter


class Block(Component):
    """A block."""

    mass = Parameter("kg", "Mass.", bounds=(1e-6, 1000))
    top = Frame("The upper end.")

    @staticmethod
    def build(p, mj):
        mj.body(mass=p.mass, center_of_mass=(0, 0, -0.1), inertia=(0.1, 0.1, 0.1))
        if p.mass > 1:
            raise ValueError("too heavy")
        mj.frame("top", (0, 0, 0))
