import math

from gaitsim.component import Component, Input, Output, Parameter


class Excess(Component):
    """What a metric has above a threshold, times a weight; nothing below: a goal that is met costs nothing."""

    weight = Parameter("1", "Cost of one unit.", default=1, bounds=(0, 1e9), source="definition: one for one")
    unit = Parameter("*", "What is called one unit.", default=1, bounds=(1e-12, 1e12), source="definition: SI")
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
