from gaitsim.component import Component, Frame, Parameter


class Skeleton(Component):
    """A uniform rod that hangs from its proximal end; replace it by your shape."""

    mass = Parameter("kg", "Mass.", bounds=(1e-6, 1000))
    length = Parameter("m", "Length from the proximal to the distal end.", bounds=(1e-3, 10))
    proximal = Frame("The end at the origin.")
    distal = Frame("The other end.")

    @staticmethod
    def build(p, mj):
        end = (0, 0, -p.length)
        transverse = p.mass * p.length**2 / 12
        mj.body(mass=p.mass, center_of_mass=(0, 0, -p.length / 2), inertia=(transverse, transverse, 1e-3 * transverse))
        mj.frame("proximal", (0, 0, 0))
        mj.frame("distal", end)
        mj.draw_rod((0, 0, 0), end, 0.04)
