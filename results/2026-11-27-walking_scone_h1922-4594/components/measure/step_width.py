import math

from gaitsim.component import Component, Input, Metric, Parameter, State


def distance_from_line(x, y, x_from, y_from, x_to, y_to):
    """Distance of a point from the line through two others; nan if these coincide."""
    along = math.sqrt((x_to - x_from) ** 2 + (y_to - y_from) ** 2)
    cross = (x_to - x_from) * (y - y_from) - (y_to - y_from) * (x - x_from)
    return abs(cross) / along if along > 0 else math.nan


class StepWidth(Component):
    """Step width (Huxham et al. 2006).

    It is the distance of the print of one foot from the line between the previous and the next print of the other
    foot, so that it does not depend on the direction of walking.
    """

    settle = Parameter(
        "s", "Earlier touchdowns do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    left = Input("1", "1 while the left leg stands, such as {from: stance_l.in_stance}.")
    right = Input("1", "1 while the right leg stands.")
    left_position = Input("m", "Forward position of a place on the left foot, such as its heel.")
    right_position = Input("m", "Forward position of the same place of the right foot.")
    left_side_position = Input("m", "Position of that place of the left foot to the left.")
    right_side_position = Input("m", "Position of that place of the right foot to the left.")

    steps = State("1", "Steps since the start.")
    before = State("1", "Whether each leg stood in the last step.", size=2)
    forward = State("m", "Forward position of each foot at its last touchdown.", size=2)
    aside = State("m", "Position of each foot at its last touchdown, to the left.", size=2)
    prints = State("1", "1 for a foot that has been set down.", size=2)
    between = State("1", "1 for a foot that has been set down since the other one was.", size=2)
    total = State("m", "Sum of the widths.")
    squares = State("m^2", "Sum of their squares.")
    count = State("1", "Number of widths.")

    value = Metric("m", "Mean step width.")
    deviation = Metric("m", "Standard deviation over steps.")

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
                side = u.left_side_position if i == 0 else u.right_side_position
                if x.prints[i] > 0.5 and x.between[1 - i] > 0.5 and x.steps * dt >= p.settle:
                    other = 1 - i
                    width = distance_from_line(x.forward[other], x.aside[other], x.forward[i], x.aside[i], here, side)
                    x.total = x.total + width
                    x.squares = x.squares + width * width
                    x.count = x.count + 1
                x.forward[i], x.aside[i], x.prints[i] = here, side, 1.0
                x.between[i], x.between[1 - i] = 1.0, 0.0
            x.before[i] = now
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        mean = x.total / x.count if x.count > 0 else math.nan
        m.value = mean
        m.deviation = math.sqrt(max(0.0, x.squares / x.count - mean * mean)) if x.count > 0 else math.nan
