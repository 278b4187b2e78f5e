from gaitsim.component import Component, Input, Output, State


class Relay(Component):
    """Passes on what arrives, and remembers it for one step."""

    signal = Input("1", "One sender.", default=0)
    more = Input("1", "Any number of senders.", sums=True)
    last = State("1", "What arrived in the last step.")
    passed = Output("1", "What arrives now.")
    before = Output("1", "What arrived in the last step.")

    @staticmethod
    def output(p, u, x, y):
        y.passed = u.signal + u.more
        y.before = x.last

    @staticmethod
    def update(p, u, x, y, dt):
        x.last = u.signal + u.more
