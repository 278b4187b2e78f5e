from gaitsim.component import Component, Input, Metric, State


class Odd(Component):
    """The last value."""

    signal = Input("*", "Any signal.")
    last = State("*", "The last value.")
    value = Metric("*", "The last value.", like="curve")
    angle = Metric("deg", "The last value.", like="last")

    @staticmethod
    def update(p, u, x, y, dt):
        x.last = u.signal

    @staticmethod
    def finish(p, x, m):
        m.value = x.last
        m.angle = 0.0
