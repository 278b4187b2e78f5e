import math

from gaitsim.component import Component, Input, Output, Parameter


class Deviation(Component):
    """Distance of a metric from a target, minus a tolerance, times a weight."""

    weight = Parameter("1", "Cost of one unit.", default=1, bounds=(0, 1e9), source="definition: one for one")
    unit = Parameter(
        "*", "Scale: the value is divided by this.", default=1, bounds=(1e-12, 1e12), source="definition: SI"
    )
    target = Parameter("*", "Target value.")
    tolerance = Parameter(
        "*", "Deviations up to this cost nothing.", default=0, source="definition: every deviation counts"
    )
    missing = Parameter(
        "1",
        "Cost if the metric has no value, such as a step length without a step.",
        default=100,
        bounds=(0, 1e9),
        source="definition: worse than any expected value",
    )
    value = Input("*", "The metric.")
    cost = Output("1", "The weighted deviation.")

    @staticmethod
    def output(p, u, x, y):
        distance = abs(u.value - p.target) - p.tolerance
        y.cost = p.missing if math.isnan(u.value) else p.weight * max(0.0, distance) / p.unit
