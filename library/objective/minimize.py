from gaitsim.component import Component, Input, Output, Parameter


class Minimize(Component):
    """A metric itself, so that the smallest value is best."""

    scale = Parameter("*", "Metric value that corresponds to a cost of 1.", default=1, source="definition: SI")
    value = Input("*", "The metric.")
    cost = Output("1", "The metric over `scale`; by default its number in SI.")

    @staticmethod
    def output(p, u, x, y):
        y.cost = u.value / p.scale
