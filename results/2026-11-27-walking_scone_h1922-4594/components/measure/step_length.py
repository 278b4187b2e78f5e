import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class StepLength(Component):
    """Step length: distance of a foot at touchdown in front of the last print of the other foot."""

    settle = Parameter(
        "s", "Earlier touchdowns do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    left = Input("1", "1 while the left leg stands, such as {from: stance_l.in_stance}.")
    right = Input("1", "1 while the right leg stands.")
    left_position = Input("m", "Forward position of a place on the left foot, such as its heel.")
    right_position = Input("m", "Forward position of the same place of the right foot.")

    steps = State("1", "Steps since the start.")
    before = State("1", "Whether each leg stood in the last step.", size=2)
    printed = State("m", "Position of each foot at its last touchdown.", size=2)
    prints = State("1", "1 for a foot that has been set down.", size=2)
    total = State("m", "Sum of the lengths of the steps that end with each leg's touchdown.", size=2)
    count = State("1", "Number of those steps.", size=2)

    value = Metric("m", "Mean step length of both legs.")
    left_length = Metric("m", "Mean length of steps that end with the left foot.")
    right_length = Metric("m", "Mean length of steps that end with the right foot.")
    stride_length = Metric("m", "Length of a left and a right step.")
    asymmetry = Metric("1", "Absolute difference of left and right over their mean.")

    @staticmethod
    def start(p, u, x):
        x.before[0] = u.left
        x.before[1] = u.right

    @staticmethod
    def update(p, u, x, y, dt):
        for i in range(2):
            now = u.left if i == 0 else u.right
            if now > 0.5 and x.before[i] < 0.5:
                here = u.left_position if i == 0 else u.right_position
                if x.prints[1 - i] > 0.5 and x.steps * dt >= p.settle:
                    x.total[i] = x.total[i] + here - x.printed[1 - i]
                    x.count[i] = x.count[i] + 1
                x.printed[i] = here
                x.prints[i] = 1.0
            x.before[i] = now
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.left_length = x.total[0] / x.count[0] if x.count[0] > 0 else math.nan
        m.right_length = x.total[1] / x.count[1] if x.count[1] > 0 else math.nan
        m.stride_length = m.left_length + m.right_length
        m.value = m.stride_length / 2
        m.asymmetry = abs(m.left_length - m.right_length) / abs(m.value) if m.value != 0 else math.nan
