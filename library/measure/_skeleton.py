from gaitsim.component import Component, Input, Metric, State


class Skeleton(Component):
    """The mean of a signal over the run; write here what yours measures."""

    signal = Input("*", "Any signal.")
    total = State("*", "Sum over the steps so far.")
    steps = State("1", "How many there were.")
    value = Metric("*", "Mean; it bears the measure's own name.")

    @staticmethod
    def update(p, u, x, y, dt):
        x.total = x.total + u.signal
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = x.total / max(1.0, x.steps)
