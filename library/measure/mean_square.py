import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class MeanSquare(Component):
    """Mean square of a signal, or of its positive or negative part."""

    unit = Parameter(
        "*", "Scale: the value is divided by this.", default=1, bounds=(1e-12, 1e12), source="definition: SI"
    )
    positive = Parameter(
        "1",
        "1 includes the positive part, 0 excludes it.",
        default=1,
        bounds=(0, 1),
        source="definition: included",
        whole=True,
    )
    negative = Parameter(
        "1",
        "1 includes the negative part, 0 excludes it.",
        default=1,
        bounds=(0, 1),
        source="definition: included",
        whole=True,
    )
    settle = Parameter(
        "s", "Samples before this time are ignored.", default=0, bounds=(0, 1e3), source="definition: the whole run"
    )
    signal = Input("*", "Any signal.")

    steps = State("1", "Steps since the start.")
    counted = State("1", "Steps that count.")
    total = State("1", "Sum of the squares over them.")

    value = Metric("1", "The mean square.")
    root = Metric("1", "Root mean square.")

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
