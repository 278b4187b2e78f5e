from gaitsim.component import Component, Input, Output, Parameter, State

from ._pulse import share_at_start, share_of_step


class Torque(Component):
    """A moment pulse at a joint, at a given time or some time after the n-th event.

    It goes to a joint by `to:`, such as `to: knee.torque`, and so has the sign of the joint's angle. In the
    first step of a run it acts only if its onset is 0.
    """

    strength = Parameter("N m", "Moment; negative for the opposite direction.", bounds=(-1e5, 1e5))
    duration = Parameter("s", "Duration of the pulse.", bounds=(0, 1e4))
    onset = Parameter(
        "s", "Time of the onset, counted from the start or from the step after the event.", bounds=(0, 1e6)
    )
    event_number = Parameter(
        "1",
        "Number of the event that it follows; 0 is the start of the run.",
        default=0,
        bounds=(0, 1e6),
        source="definition: a moment at a given time",
        whole=True,
    )
    event = Input("1", "1 in the instant of an event, such as touchdown.", default=0)
    events = State("1", "Number of events so far.")
    steps = State("1", "Steps since the pulse's time began; -1 before.")
    level = State("1", "Share of the moment in this step.")
    torque = Output("N m", "Moment at the joint.")

    @staticmethod
    def start(p, u, x):
        x.events = 0.0
        x.steps = 0.0 if p.event_number < 0.5 else -1.0
        x.level = share_at_start(p)

    @staticmethod
    def output(p, u, x, y):
        y.torque = p.strength * x.level

    @staticmethod
    def update(p, u, x, y, dt):
        x.events = x.events + 1 if u.event > 0.5 else x.events
        if x.steps > -0.5 or (u.event > 0.5 and x.events >= p.event_number):
            x.steps = x.steps + 1
            x.level = share_of_step(x.steps * dt, dt, p.onset, p.duration)
