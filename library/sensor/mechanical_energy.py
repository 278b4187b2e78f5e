from gaitsim.component import Component, Output


class MechanicalEnergy(Component):
    """Energy of all bodies: potential (0 at the ground's origin) and kinetic."""

    potential = Output("N m", "Potential energy in gravity and in MuJoCo's springs.")
    kinetic = Output("N m", "Kinetic energy.")
    total = Output("N m", "Their sum.")

    @staticmethod
    def output(p, u, x, y):
        y.total = y.potential + y.kinetic

    @staticmethod
    def build(p, mj):
        mj.read_energy("potential", "kinetic")
