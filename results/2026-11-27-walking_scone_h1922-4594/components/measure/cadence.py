import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Cadence(Component):
    """Cadence: touchdowns of both legs per minute."""

    settle = Parameter(
        "s", "Earlier touchdowns do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    left = Input("1", "1 while the left leg stands, such as {from: stance_l.in_stance}.")
    right = Input("1", "1 while the right leg stands.")

    steps = State("1", "Steps since the start.")
    before = State("1", "Whether each leg stood in the last step.", size=2)
    touchdowns = State("1", "Number of touchdowns that count.")
    first = State("s", "Time of the first of them.")
    last = State("s", "Time of the last of them.")

    value = Metric("1/min", "Steps per minute between the first and the last touchdown that count.")
    touchdown_count = Metric("1", "Number of touchdowns that count.")
    step_time = Metric("s", "Mean duration of a step.")

    @staticmethod
    def start(p, u, x):
        x.before[0] = u.left
        x.before[1] = u.right

    @staticmethod
    def update(p, u, x, y, dt):
        now = x.steps * dt
        for i in range(2):
            stands = u.left if i == 0 else u.right
            if stands > 0.5 and x.before[i] < 0.5 and now >= p.settle:
                x.first = now if x.touchdowns < 0.5 else x.first
                x.last = now
                x.touchdowns = x.touchdowns + 1
            x.before[i] = stands
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.touchdown_count = x.touchdowns
        m.step_time = (x.last - x.first) / (x.touchdowns - 1) if x.touchdowns > 1 else math.nan
        m.value = 1 / m.step_time if m.step_time > 0 else math.nan
