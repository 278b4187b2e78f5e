from gaitsim.component import Component, Input, Output, Parameter


class Skeleton(Component):
    """The distance of a metric from a target, |v - v_0|; replace it by your cost. The smallest cost is best."""

    wanted = Parameter("1", "v_0: target.", default=1, bounds=(-1e6, 1e6), source="definition: a starting value")
    value = Input("1", "A metric.")
    cost = Output("1", "The cost, which is minimised.")

    @staticmethod
    def output(p, u, x, y):
        y.cost = abs(u.value - p.wanted)
