from gaitsim.component import Component, Input, Output


class MetabolicPower(Component):
    """Sum of metabolic powers: of all muscles of a leg, whoever sends one."""

    powers = Input("W", "Metabolic powers of muscles.", sums=True)
    power = Output("W", "Their sum.")

    @staticmethod
    def output(p, u, x, y):
        y.power = u.powers
