from gaitsim.component import Component, Input, Output


class ElasticEnergy(Component):
    """Sum of elastic energies: of tendons, stops, contacts, constraints, whoever sends one."""

    energy = Input("J", "Elastic energies.", sums=True)
    total = Output("J", "Their sum.")
    weight = Output("N", "Weight of all that moves.")

    @staticmethod
    def output(p, u, x, y):
        y.total = u.energy

    @staticmethod
    def build(p, mj):
        mj.read_weight("weight")
