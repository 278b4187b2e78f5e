import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class LoadLimit(Component):
    """Excess of the vertical force on the feet over a limit, in body weights, averaged over time."""

    limit = Parameter("1", "Largest allowed force on one foot, in body weights.", bounds=(0, 100))
    settle = Parameter(
        "s", "Samples before this time are ignored.", default=1, bounds=(0, 1e3), source="definition: the first stride"
    )
    left = Input("1", "Vertical force on the left foot in body weights.")
    right = Input("1", "Vertical force on the right foot in body weights.", default=0)

    steps = State("1", "Steps since the start.")
    counted = State("1", "Steps that count.")
    total = State("1", "Sum of the excess over them.")
    highest = State("1", "Largest force.")
    above = State("1", "Number of steps with too much force on a foot.")

    value = Metric("1", "Excess over the limit, summed over both feet and averaged over time.")
    peak = Metric("1", "Largest force on a foot.")
    share = Metric("1", "Share of the time with too much force on a foot.")

    @staticmethod
    def update(p, u, x, y, dt):
        if x.steps * dt >= p.settle:
            excess = max(0.0, u.left - p.limit) + max(0.0, u.right - p.limit)
            x.counted = x.counted + 1
            x.total = x.total + excess
            x.highest = max(x.highest, max(u.left, u.right))
            x.above = x.above + (1.0 if excess > 0 else 0.0)
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = x.total / x.counted if x.counted > 0 else math.nan
        m.peak = x.highest if x.counted > 0 else math.nan
        m.share = x.above / x.counted if x.counted > 0 else math.nan
