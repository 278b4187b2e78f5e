import math

from gaitsim.component import Component, Input, Output, Parameter


class Shortfall(Component):
    """Cost of a metric below a threshold: the difference times a weight; 0 above the threshold."""

    weight = Parameter("1", "Cost of one unit.", default=1, bounds=(0, 1e9), source="definition: one for one")
    unit = Parameter(
        "*", "Scale: the value is divided by this.", default=1, bounds=(1e-12, 1e12), source="definition: SI"
    )
    threshold = Parameter("*", "The cost is 0 from this value on.")
    missing = Parameter(
        "1",
        "Cost if the metric has no value, such as a step length without a step.",
        default=100,
        bounds=(0, 1e9),
        source="definition: worse than any expected value",
    )
    value = Input("*", "The metric.")
    cost = Output("1", "The weighted shortfall.")

    @staticmethod
    def output(p, u, x, y):
        y.cost = p.missing if math.isnan(u.value) else p.weight * max(0.0, p.threshold - u.value) / p.unit
