from gaitsim.component import Component, Input, Metric, State


class Skeleton(Component):
    """The mean of a signal over the run; replace it by your measure."""

    signal = Input("*", "Any signal.")
    total = State("*", "Sum over the steps so far.")
    steps = State("1", "Number of steps so far.")
    value = Metric("*", "Mean; the metric has the name of the part.")

    @staticmethod
    def update(p, u, x, y, dt):
        x.total = x.total + u.signal
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = x.total / max(1.0, x.steps)
