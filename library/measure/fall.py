from gaitsim.component import Component, Input, Metric, Output, Parameter, State


class Fall(Component):
    """Ends the run when a height falls below a limit."""

    below = Parameter("m", "The run ends below this height.", bounds=(-10, 10))
    height = Input("m", "Height of what must stay up.")
    steps = State("1", "Steps since the start.")
    time = State("s", "Time since the start.")
    stop = Output("1", "1 ends the run.")

    value = Metric("s", "How long it stayed up.")

    @staticmethod
    def output(p, u, x, y):
        y.stop = 1.0 if u.height < p.below else 0.0

    @staticmethod
    def update(p, u, x, y, dt):
        x.steps = x.steps + 1
        x.time = x.steps * dt

    @staticmethod
    def finish(p, x, m):
        m.value = x.time
