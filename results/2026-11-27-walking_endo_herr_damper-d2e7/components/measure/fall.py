import math

from gaitsim.component import Component, Input, Metric, Output, Parameter, State


class Fall(Component):
    """Detects a fall, when a height is below a limit or the trunk leans too far, and ends the run one step later."""

    below = Parameter("m", "The run ends below this height.", bounds=(-10, 10))
    beyond = Parameter(
        "rad",
        "The run ends if the trunk leans further, forwards or backwards.",
        default=math.inf,
        bounds=(0, math.inf),
        source="definition: only the height counts",
    )
    height = Input("m", "Height that must stay above the limit.")
    lean = Input("rad", "Angle of the trunk from the vertical.", default=0)
    steps = State("1", "Steps since the start.")
    time = State("s", "Time since the start, until the fall.")
    fallen = State("1", "1 from the fall on.")
    stop = Output("1", "1 ends the run.")

    value = Metric("s", "Time until the fall; without a fall, the duration of the run.")
    fell = Metric("1", "1 if it fell, else 0.")

    @staticmethod
    def output(p, u, x, y):
        y.stop = x.fallen

    @staticmethod
    def update(p, u, x, y, dt):
        if u.height < p.below or abs(u.lean) > p.beyond:
            x.fallen = 1.0
        else:
            x.steps = x.steps + 1
        x.time = x.steps * dt

    @staticmethod
    def finish(p, x, m):
        m.value = x.time
        m.fell = x.fallen
