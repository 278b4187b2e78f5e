import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Symmetry(Component):
    """Symmetry index of the mean absolute value of a signal on the left and the right; 0 if they are equal.

    It compares averages over the run, not the timing of the legs.
    """

    settle = Parameter(
        "s", "Samples before this time are ignored.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    left = Input("*", "The signal of the left leg.")
    right = Input("*", "The same signal of the right leg.")

    steps = State("1", "Steps since the start.")
    counted = State("1", "Steps that count.")
    lefts = State("*", "Sum of the absolute left signal.")
    rights = State("*", "Sum of the absolute right signal.")

    value = Metric("1", "Absolute difference of the means over their mean; 2 if one signal is 0.")
    left_mean = Metric("*", "Mean absolute left signal.")
    right_mean = Metric("*", "Mean absolute right signal.")

    @staticmethod
    def update(p, u, x, y, dt):
        if x.steps * dt >= p.settle:
            x.counted = x.counted + 1
            x.lefts = x.lefts + abs(u.left)
            x.rights = x.rights + abs(u.right)
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.left_mean = x.lefts / x.counted if x.counted > 0 else math.nan
        m.right_mean = x.rights / x.counted if x.counted > 0 else math.nan
        both = x.lefts + x.rights
        m.value = 2 * abs(x.lefts - x.rights) / both if both > 0 else math.nan
