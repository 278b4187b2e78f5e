import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Work(Component):
    """The work of a unit along its path in a stride: given while the path shortens, taken while it lengthens.

    Whole strides count, from touchdown to touchdown. The net work of a spring in them is not above zero, but for
    what it holds more at the first touchdown than at the last.
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
    strides = State("1", "How many strides count.")
    force_before = State("N", "Force one step ago.")
    length_before = State("m", "Length one step ago.")
    positive = State("J", "Work given since the first touchdown that counts.")
    negative = State("J", "Work taken since then.")
    given_until = State("J", "Work given until the last touchdown.")
    taken_until = State("J", "Work taken until then.")

    value = Metric("J", "Net work in a stride: given less taken.")
    given = Metric("J", "Work given in a stride.")
    taken = Metric("J", "Work taken in a stride.")

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
