from gaitsim.component import Component, Input, Output, Parameter


class Maximize(Component):
    """Negative of a metric, so that the largest value is best."""

    scale = Parameter("*", "Metric value that corresponds to a cost of 1.", default=1, source="definition: SI")
    value = Input("*", "The metric.")
    cost = Output("1", "Minus the metric over `scale`; by default minus its number in SI.")

    @staticmethod
    def output(p, u, x, y):
        y.cost = -u.value / p.scale
