from gaitsim.component import Component, Input, Output, Parameter


class Skeleton(Component):
    """The distance of a metric from what is wanted, |v - v_0|; write here what a good model is. Least is best."""

    wanted = Parameter("1", "v_0.", default=1, bounds=(-1e6, 1e6), source="definition: a beginning")
    value = Input("1", "A metric.")
    cost = Output("1", "The cost, which is minimised.")

    @staticmethod
    def output(p, u, x, y):
        y.cost = abs(u.value - p.wanted)
