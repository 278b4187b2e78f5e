import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class SwingAngle(Component):
    """The largest angle of a joint in swing, such as the flexion of the knee, averaged over swings."""

    settle = Parameter(
        "s", "Swings that begin earlier do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    direction = Parameter(
        "1",
        "-1 if the joint has the opposite sign convention.",
        default=1,
        bounds=(-1, 1),
        source="definition: as is",
        whole=True,
    )
    zero = Parameter(
        "rad", "Angle of the joint that counts as 0.", default=0, bounds=(-7, 7), source="definition: as is"
    )
    angle = Input("rad", "Angle of the joint.")
    stance = Input("1", "1 while the leg stands, such as {from: stance_r.in_stance}.")

    steps = State("1", "Steps since the start.")
    before = State("1", "Whether the leg stood in the last step.")
    counting = State("1", "1 in a swing that counts.")
    highest = State("rad", "Largest angle of the present swing.")
    total = State("rad", "Sum over the swings that have ended.")
    greatest = State("rad", "Largest angle so far.")
    count = State("1", "Number of those swings.")

    value = Metric("deg", "Mean of the largest angles of all swings.")
    largest = Metric("deg", "Largest angle of all swings.")
    swings = Metric("1", "Number of swings that count.")

    @staticmethod
    def start(p, u, x):
        x.before = u.stance

    @staticmethod
    def update(p, u, x, y, dt):
        angle = p.direction * (u.angle - p.zero)
        if u.stance < 0.5:
            if x.before > 0.5:
                x.counting = 1.0 if x.steps * dt >= p.settle else 0.0
                x.highest = angle
            x.highest = max(x.highest, angle)
        elif x.before < 0.5 and x.counting > 0.5:
            x.greatest = x.highest if x.count < 0.5 else max(x.greatest, x.highest)
            x.total = x.total + x.highest
            x.count = x.count + 1
        x.before = u.stance
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.swings = x.count
        m.value = x.total / x.count if x.count > 0 else math.nan
        m.largest = x.greatest if x.count > 0 else math.nan
