from gaitsim.component import Component, Input, Output


class Load(Component):
    """Sum of loads in body weights, such as those of all contacts of a leg."""

    loads = Input("1", "Loads in body weights.", sums=True)
    load = Output("1", "Their sum.")

    @staticmethod
    def output(p, u, x, y):
        y.load = u.loads
