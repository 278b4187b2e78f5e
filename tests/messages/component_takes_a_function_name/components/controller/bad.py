from gaitsim.component import Component, Option, Output


class Bad(Component):
    """Something."""

    start = Option("A word.", choices=("a", "b"), default="a")
    force = Output("N", "A force.")

    @staticmethod
    def output(p, u, x, y):
        y.force = 1.0
