import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Work(Component):
    """The work of a unit along its path: what it gives while the path shortens, and takes while it lengthens.

    Over whole strides the net work of a spring is not above zero; that of a muscle may be.
    """

    settle = Parameter(
        "s", "What is earlier does not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    force = Input("N", "Force of the unit.")
    length = Input("m", "Length of its path.")

    steps = State("1", "Steps since the start.")
    force_before = State("N", "Force one step ago.")
    length_before = State("m", "Length one step ago.")
    time = State("s", "Time that counts.")
    positive = State("J", "Work given.")
    negative = State("J", "Work taken.")

    value = Metric("W", "Net work over time: given less taken.")
    given = Metric("W", "Work given over time.")
    taken = Metric("W", "Work taken over time.")

    @staticmethod
    def start(p, u, x):
        x.force_before = u.force
        x.length_before = u.length

    @staticmethod
    def update(p, u, x, y, dt):
        if x.steps * dt > p.settle:
            work = 0.5 * (u.force + x.force_before) * (x.length_before - u.length)
            x.time = x.time + dt
            x.positive = x.positive + max(0.0, work)
            x.negative = x.negative + max(0.0, -work)
        x.force_before = u.force
        x.length_before = u.length
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        lasted = x.time > 0
        m.given = x.positive / x.time if lasted else math.nan
        m.taken = x.negative / x.time if lasted else math.nan
        m.value = m.given - m.taken
