import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Work(Component):
    """Work of a muscle-tendon unit per stride: positive while its path shortens, negative while it lengthens.

    Only whole strides count, from touchdown to touchdown. The net work of a spring is not above 0, apart from the
    energy that it holds at the first touchdown beyond that at the last.
    """

    settle = Parameter(
        "s", "Strides that begin earlier do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    force = Input("N", "Force of the unit.")
    length = Input("m", "Length of its path.")
    stance = Input("1", "1 while the leg stands, such as {from: stance_r.in_stance}.")

    steps = State("1", "Steps since the start.")
    before = State("1", "Whether the leg stood in the last step.")
    counting = State("1", "1 from the first touchdown that counts.")
    strides = State("1", "Number of strides that count.")
    force_before = State("N", "Force one step ago.")
    length_before = State("m", "Length one step ago.")
    positive = State("J", "Positive work since the first touchdown that counts.")
    negative = State("J", "Negative work since the first touchdown that counts.")
    given_until = State("J", "Positive work until the last touchdown.")
    taken_until = State("J", "Negative work until the last touchdown.")

    value = Metric("J", "Net work per stride.")
    given = Metric("J", "Positive work per stride.")
    taken = Metric("J", "Negative work per stride, as a positive number.")

    @staticmethod
    def start(p, u, x):
        x.before = u.stance
        x.force_before = u.force
        x.length_before = u.length

    @staticmethod
    def update(p, u, x, y, dt):
        if x.counting > 0.5:
            work = 0.5 * (u.force + x.force_before) * (x.length_before - u.length)
            x.positive = x.positive + max(0.0, work)
            x.negative = x.negative + max(0.0, -work)
        if u.stance > 0.5 and x.before < 0.5 and x.steps * dt >= p.settle:
            x.strides = x.strides + x.counting
            x.counting = 1.0
            x.given_until = x.positive
            x.taken_until = x.negative
        x.before = u.stance
        x.force_before = u.force
        x.length_before = u.length
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.given = x.given_until / x.strides if x.strides > 0 else math.nan
        m.taken = x.taken_until / x.strides if x.strides > 0 else math.nan
        m.value = m.given - m.taken
