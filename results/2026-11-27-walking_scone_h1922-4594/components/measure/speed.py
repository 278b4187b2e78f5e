import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Speed(Component):
    """Mean forward speed after the gait has settled, and total distance."""

    settle = Parameter(
        "s", "The mean is taken from this time on.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    position = Input("m", "Forward position, such as that of the pelvis.")

    steps = State("1", "Steps since the start.")
    time = State("s", "Time of the last position.")
    origin = State("m", "Position at the start.")
    begin = State("m", "Position where the mean begins.")
    begin_time = State("s", "Time at which the mean begins.")
    last = State("m", "Last position.")

    value = Metric("m/s", "Mean speed after settling; no value if the run ends before.")
    distance = Metric("m", "Distance from the start to the end of the run.")

    @staticmethod
    def start(p, u, x):
        x.origin = u.position
        x.begin = u.position
        x.last = u.position

    @staticmethod
    def update(p, u, x, y, dt):
        x.time = x.steps * dt
        if x.time <= p.settle:
            x.begin = u.position
            x.begin_time = x.time
        x.last = u.position
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        lasted = x.time - x.begin_time
        m.value = (x.last - x.begin) / lasted if lasted > 0 else math.nan
        m.distance = x.last - x.origin
