from gaitsim.component import Component, Input, Output


class ElasticEnergy(Component):
    """Sum of elastic energies, such as those of tendons, stops, contacts and constraints."""

    energy = Input("J", "Elastic energies.", sums=True)
    total = Output("J", "Their sum.")
    weight = Output("N", "Weight of the whole model.")

    @staticmethod
    def output(p, u, x, y):
        y.total = u.energy

    @staticmethod
    def build(p, mj):
        mj.read_weight("weight")
