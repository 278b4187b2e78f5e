import math

from gaitsim.component import Component, Input, Output, Parameter


class Excess(Component):
    """Cost of a metric above a threshold: the difference times a weight; 0 below the threshold."""

    weight = Parameter("1", "Cost of one unit.", default=1, bounds=(0, 1e9), source="definition: one for one")
    unit = Parameter("*", "Value that counts as 1.", default=1, bounds=(1e-12, 1e12), source="definition: SI")
    threshold = Parameter("*", "Up to here it costs nothing.", default=0, source="definition: every excess counts")
    missing = Parameter(
        "1",
        "Cost if the metric has no value, as a step length without a step.",
        default=100,
        bounds=(0, 1e9),
        source="definition: worse than any value that is meant",
    )
    value = Input("*", "The metric.")
    cost = Output("1", "The weighted excess.")

    @staticmethod
    def output(p, u, x, y):
        y.cost = p.missing if math.isnan(u.value) else p.weight * max(0.0, u.value - p.threshold) / p.unit
