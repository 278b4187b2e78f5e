from gaitsim.component import Component, Input, Output


class MetabolicPower(Component):
    """Sum of metabolic powers, such as those of all muscles of a leg."""

    powers = Input("W", "Metabolic powers of muscles.", sums=True)
    power = Output("W", "Their sum.")

    @staticmethod
    def output(p, u, x, y):
        y.power = u.powers
