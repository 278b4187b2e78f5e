import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class StrideRange(Component):
    """Range of a signal within a stride, such as pelvic obliquity; mean over strides."""

    settle = Parameter(
        "s", "Strides that begin earlier do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    signal = Input("*", "Any signal.")
    stance = Input("1", "1 while a leg stands, such as {from: stance_r.in_stance}; its touchdowns delimit the strides.")

    steps = State("1", "Steps since the start.")
    before = State("1", "Whether the leg stood in the last step.")
    counted = State(levels=("no", "yes"), doc="Whether the present stride counts.")
    lowest = State("*", "Smallest value in this stride.")
    highest = State("*", "Largest value in this stride.")
    low_sum = State("*", "Sum of the smallest values.")
    high_sum = State("*", "Sum of the largest values.")
    count = State("1", "Number of strides that counted.")

    value = Metric("*", "Mean of highest minus lowest value.")
    low = Metric("*", "Mean of the smallest value.")
    high = Metric("*", "Mean of the largest value.")

    @staticmethod
    def start(p, u, x):
        x.before = u.stance

    @staticmethod
    def update(p, u, x, y, dt):
        if u.stance > 0.5 and x.before < 0.5:
            if x.counted == 1:
                x.low_sum = x.low_sum + x.lowest
                x.high_sum = x.high_sum + x.highest
                x.count = x.count + 1
            x.counted = 1 if x.steps * dt >= p.settle else 0
            x.lowest = u.signal
            x.highest = u.signal
        x.lowest = min(x.lowest, u.signal)
        x.highest = max(x.highest, u.signal)
        x.before = u.stance
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.low = x.low_sum / x.count if x.count > 0 else math.nan
        m.high = x.high_sum / x.count if x.count > 0 else math.nan
        m.value = m.high - m.low
