import math

from gaitsim.component import Component, Input, Output, Parameter


class Excess(Component):
    """Cost of a metric above a threshold: the difference times a weight; 0 below the threshold."""

    weight = Parameter("1", "Cost of one unit.", default=1, bounds=(0, 1e9), source="definition: one for one")
    unit = Parameter(
        "*", "Scale: the value is divided by this.", default=1, bounds=(1e-12, 1e12), source="definition: SI"
    )
    threshold = Parameter("*", "Values up to this cost nothing.", default=0, source="definition: every excess counts")
    missing = Parameter(
        "1",
        "Cost if the metric has no value, such as a step length without a step.",
        default=100,
        bounds=(0, 1e9),
        source="definition: worse than any expected value",
    )
    value = Input("*", "The metric.")
    cost = Output("1", "The weighted excess.")

    @staticmethod
    def output(p, u, x, y):
        y.cost = p.missing if math.isnan(u.value) else p.weight * max(0.0, u.value - p.threshold) / p.unit
