from gaitsim.component import Component, Output


class MechanicalEnergy(Component):
    """Energy of all bodies: potential (0 at the ground's origin) and kinetic."""

    potential = Output("J", "Potential energy in gravity and in MuJoCo's springs.")
    kinetic = Output("J", "Kinetic energy.")
    total = Output("J", "Their sum.")

    @staticmethod
    def output(p, u, x, y):
        y.total = y.potential + y.kinetic

    @staticmethod
    def build(p, mj):
        mj.read_energy("potential", "kinetic")
