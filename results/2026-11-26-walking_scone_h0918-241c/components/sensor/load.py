from gaitsim.component import Component, Input, Output


class Load(Component):
    """Sum of loads in body weights: of all contacts of a leg, whoever sends one."""

    loads = Input("1", "Loads in body weights.", sums=True)
    load = Output("1", "Their sum.")

    @staticmethod
    def output(p, u, x, y):
        y.load = u.loads
