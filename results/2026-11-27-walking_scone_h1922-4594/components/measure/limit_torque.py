import math

from gaitsim.component import Component, Input, Metric, Output, Parameter, State


class LimitTorque(Component):
    """Load on the stops of a joint: mean over time and peak of their absolute torque.

    A further part sums several joints: `to: limits.signal`, with `limits: {use: measure/total}`.
    """

    settle = Parameter(
        "s", "Samples before this time are ignored.", default=1, bounds=(0, 1e3), source="definition: the first stride"
    )
    torque = Input("N m", "Torque of a joint's stops, such as {from: knee.stop}.")

    steps = State("1", "Steps since the start.")
    counted = State("1", "Steps that count.")
    total = State("N m", "Sum of the torque over them.")
    highest = State("N m", "Largest torque.")
    magnitude = Output("N m", "Absolute torque.")

    value = Metric("N m", "Mean over time.")
    peak = Metric("N m", "Largest torque.")

    @staticmethod
    def output(p, u, x, y):
        y.magnitude = abs(u.torque)

    @staticmethod
    def update(p, u, x, y, dt):
        if x.steps * dt >= p.settle:
            x.counted = x.counted + 1
            x.total = x.total + abs(u.torque)
            x.highest = max(x.highest, abs(u.torque))
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = x.total / x.counted if x.counted > 0 else math.nan
        m.peak = x.highest if x.counted > 0 else math.nan
