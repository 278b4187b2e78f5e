import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class MeanSquare(Component):
    """The mean over time of a signal's square, or of the square of its positive or its negative part."""

    unit = Parameter("*", "Value that counts as 1.", default=1, bounds=(1e-12, 1e12), source="definition: SI")
    positive = Parameter(
        "1", "1 if the positive part counts, 0 if not.", default=1, bounds=(0, 1), source="definition: all counts"
    )
    negative = Parameter(
        "1", "1 if the negative part counts, 0 if not.", default=1, bounds=(0, 1), source="definition: all counts"
    )
    settle = Parameter(
        "s", "Samples before this time are ignored.", default=0, bounds=(0, 1e3), source="definition: the whole run"
    )
    signal = Input("*", "Any signal.")

    steps = State("1", "Steps since the start.")
    counted = State("1", "Steps that count.")
    total = State("1", "Sum of the squares over them.")

    value = Metric("1", "The mean square.")
    root = Metric("1", "Its root.")

    @staticmethod
    def update(p, u, x, y, dt):
        if x.steps * dt >= p.settle:
            part = p.positive * max(0.0, u.signal / p.unit) + p.negative * max(0.0, -u.signal / p.unit)
            x.counted = x.counted + 1
            x.total = x.total + part * part
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = x.total / x.counted if x.counted > 0 else math.nan
        m.root = math.sqrt(m.value)
