import math

from gaitsim.component import Attachment, Component, Input, Option, Output, Parameter, State

from ._pulse import share_at_start, share_of_step


class Push(Component):
    """A force pulse on a segment, at a given time or some time after the n-th event.

    In the first step of a run it acts only if its onset is 0.
    """

    frame = Attachment("The frame on which the force acts.")
    direction = Option("Direction in the world frame.", choices=("forward", "left", "up"), default="forward")
    azimuth = Parameter(
        "deg",
        "Turn of the direction to the left, about the upward axis.",
        default=0,
        bounds=(-360, 360),
        source="definition: along the axis",
    )
    strength = Parameter("N", "Force; negative for the opposite direction.", bounds=(-1e5, 1e5))
    duration = Parameter("s", "Duration of the pulse.", bounds=(0, 1e4))
    onset = Parameter(
        "s", "Time of the onset, counted from the start or from the step after the event.", bounds=(0, 1e6)
    )
    event_number = Parameter(
        "1",
        "Number of the event that it follows; 0 is the start of the run.",
        default=0,
        bounds=(0, 1e6),
        source="definition: a push at a given time",
        whole=True,
    )
    event = Input("1", "1 in the instant of an event, such as touchdown.", default=0)
    events = State("1", "Number of events so far.")
    steps = State("1", "Steps since the pulse's time began; -1 before.")
    level = State("1", "Share of the force in this step.")
    force = Output("N", "Force on the frame.")

    @staticmethod
    def start(p, u, x):
        x.events = 0.0
        x.steps = 0.0 if p.event_number < 0.5 else -1.0
        x.level = share_at_start(p)

    @staticmethod
    def output(p, u, x, y):
        y.force = p.strength * x.level

    @staticmethod
    def update(p, u, x, y, dt):
        x.events = x.events + 1 if u.event > 0.5 else x.events
        if x.steps > -0.5 or (u.event > 0.5 and x.events >= p.event_number):
            x.steps = x.steps + 1
            x.level = share_of_step(x.steps * dt, dt, p.onset, p.duration)

    @staticmethod
    def build(p, mj):
        x, y, z = {"forward": (1, 0, 0), "left": (0, 1, 0), "up": (0, 0, 1)}[p.direction]
        cosine, sine = math.cos(p.azimuth), math.sin(p.azimuth)
        axis = (x * cosine - y * sine, x * sine + y * cosine, z)
        mj.apply("force", mj.push(mj.attached("frame"), axis=axis), "ctrl")
