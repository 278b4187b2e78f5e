from gaitsim.component import Component, Input, Output, Parameter, State


class Clock(Component):
    """A phase that runs from 0 to 1 and restarts after each period and at each event.

    Without events it is a free-running rhythm. With touchdowns as events it is the phase of the stride.
    """

    period = Parameter("s", "Duration of a cycle.", bounds=(1e-3, 1e4))
    first_phase = Parameter(
        "1",
        "Phase at the start and at an event.",
        default=0,
        bounds=(0, 1),
        source="definition: the cycle begins",
    )
    event = Input("1", "1 in the instant of an event, else 0.", default=0)
    steps = State("1", "Steps since the start or the last event.")
    coming = State("1", "Phase if there is no event.")
    phase = Output("1", "Phase, from 0 up to but not including 1.")

    @staticmethod
    def start(p, u, x):
        x.steps = 0.0
        x.coming = p.first_phase % 1

    @staticmethod
    def output(p, u, x, y):
        y.phase = p.first_phase % 1 if u.event > 0.5 else x.coming

    @staticmethod
    def update(p, u, x, y, dt):
        x.steps = 1.0 if u.event > 0.5 else x.steps + 1
        x.coming = (p.first_phase + x.steps * dt / p.period) % 1
