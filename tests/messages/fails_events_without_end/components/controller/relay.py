from gaitsim.component import Component, Input, Output, Parameter, State


class Relay(Component):
    """A relay that changes sides as soon as it is on the side of another (taste 1), or is not (taste -1)."""

    taste = Parameter("1", "What it dislikes.", bounds=(-1, 1))
    other = Input("1", "Side of the other: 1 or -1.")
    own = State("1", "Side of its own.")
    side = Output("1", "Side of its own.")
    guard = Output("1", "1 if it must change sides.")

    @staticmethod
    def output(p, u, x, y):
        y.side = x.own
        y.guard = p.taste * x.own * u.other

    @staticmethod
    def reset(p, u, x, y, t):
        x.own = -x.own

    @staticmethod
    def update(p, u, x, y, dt):
        x.own = 1.0
