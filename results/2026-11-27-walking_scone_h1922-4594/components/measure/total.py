import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Total(Component):
    """Sum of several signals, such as the efforts of all muscles: its mean over time and its peak."""

    settle = Parameter(
        "s", "Samples before this time are ignored.", default=0, bounds=(0, 1e3), source="definition: the whole run"
    )
    signal = Input("*", "Signals that are summed; connected by to: of their parts.", sums=True)

    steps = State("1", "Steps since the start.")
    counted = State("1", "Steps that count.")
    sum = State("*", "Sum over them.")
    highest = State("*", "Largest value.")

    value = Metric("*", "Mean over time.")
    peak = Metric("*", "Largest value.")

    @staticmethod
    def update(p, u, x, y, dt):
        if x.steps * dt >= p.settle:
            x.highest = u.signal if x.counted < 0.5 else max(x.highest, u.signal)
            x.counted = x.counted + 1
            x.sum = x.sum + u.signal
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = x.sum / x.counted if x.counted > 0 else math.nan
        m.peak = x.highest if x.counted > 0 else math.nan
