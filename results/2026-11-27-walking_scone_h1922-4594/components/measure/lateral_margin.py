import math

from gaitsim.component import Component, Input, Metric, Parameter, State


def sideways(forward, left, heading):
    """How far a place is to the left, seen along a heading."""
    return left * math.cos(heading) - forward * math.sin(heading)


class LateralMargin(Component):
    """Lateral margin of stability (Hof et al. 2005): how far the extrapolated center of mass stays inside of a foot.

    The extrapolated center of mass is x + v sqrt(l / g), with the height l of the center of mass. A margin is the
    least distance from it to the foot's outer border while that foot alone stands. A negative one says that the
    walker falls to this side unless it crosses its legs. Sides are seen along the heading.
    """

    settle = Parameter("s", "Earlier steps do not count.", default=2, bounds=(0, 1e3), source="definition: two strides")
    border = Parameter(
        "m",
        "How far the outer border is from the place on the foot.",
        default=0,
        bounds=(-1, 1),
        source="definition: the place is the border",
    )
    gravity = Parameter("m/s^2", "g.", default=9.81, bounds=(0.1, 100), source="geyer2003")
    heading = Input("rad", "Way of the walker to the left of the x axis, at which it may go.", default=0)
    left = Input("1", "1 while the left leg stands, such as {from: stance_l.in_stance}.")
    right = Input("1", "1 while the right leg stands.")
    left_position = Input("m", "Forward position of a place on the left foot, such as its lateral toe.")
    right_position = Input("m", "Forward position of the same place of the right foot.")
    left_side_position = Input("m", "Position of that place of the left foot to the left.")
    right_side_position = Input("m", "Position of that place of the right foot to the left.")
    center_position = Input("m", "Forward position of the center of mass.")
    center_side_position = Input("m", "Its position to the left.")
    center_velocity = Input("m/s", "Its velocity forwards.")
    center_side_velocity = Input("m/s", "Its velocity to the left.")
    center_height = Input("m", "Its height.")

    steps = State("1", "Steps since the start.")
    alone = State("1", "Foot that stands alone: -1 the right one, 1 the left one, 0 neither.")
    least = State("m", "Least distance since it stands alone.")
    total = State("m", "Sum of the margins.")
    squares = State("m^2", "Sum of their squares.")
    count = State("1", "How many they were.")
    smallest = State("m", "Smallest margin.")

    value = Metric("m", "Mean over the steps.")
    deviation = Metric("m", "Standard deviation from step to step.")
    lowest = Metric("m", "Smallest of all.")

    @staticmethod
    def update(p, u, x, y, dt):
        alone = (1.0 if u.left > 0.5 else 0.0) - (1.0 if u.right > 0.5 else 0.0)
        time = math.sqrt(max(0.0, u.center_height) / p.gravity)
        forward = u.center_position + time * u.center_velocity
        aside = u.center_side_position + time * u.center_side_velocity
        ahead = u.left_position if alone > 0 else u.right_position
        foot = u.left_side_position if alone > 0 else u.right_side_position
        inside = sideways(ahead, foot, u.heading) - sideways(forward, aside, u.heading)
        margin = p.border + alone * inside
        if alone == x.alone:
            x.least = min(x.least, margin)
        else:
            if x.alone != 0 and x.steps * dt >= p.settle:
                x.smallest = x.least if x.count == 0 else min(x.smallest, x.least)
                x.total = x.total + x.least
                x.squares = x.squares + x.least * x.least
                x.count = x.count + 1
            x.alone, x.least = alone, margin
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = x.total / x.count if x.count > 0 else math.nan
        m.lowest = x.smallest if x.count > 0 else math.nan
        m.deviation = math.sqrt(max(0.0, x.squares / x.count - m.value * m.value)) if x.count > 0 else math.nan
