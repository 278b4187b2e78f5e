import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Symmetry(Component):
    """How unlike left and right are: the symmetry index of the mean size of a signal, 0 if they are alike.

    Over whole minutes this compares what the legs do on average, not when they do it.
    """

    settle = Parameter(
        "s", "Samples before this time are ignored.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    left = Input("*", "The signal of the left leg.")
    right = Input("*", "The same of the right leg.")

    steps = State("1", "Steps since the start.")
    counted = State("1", "Steps that count.")
    lefts = State("*", "Sum of the left signal without its sign.")
    rights = State("*", "Sum of the right one.")

    value = Metric("1", "Difference of the means over their mean, without sign; 2 if one leg does nothing.")
    left_mean = Metric("*", "Mean of the left signal without its sign.")
    right_mean = Metric("*", "Mean of the right one.")

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
