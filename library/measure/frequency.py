import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Frequency(Component):
    """Frequency at which a signal switches on, such as touchdowns per second."""

    average = Parameter(
        "1",
        "Number of most recent periods that are averaged.",
        default=3,
        bounds=(1, 15),
        source="thesis: last three",
        whole=True,
    )
    signal = Input("1", "0 or 1; an event is its rise.")

    times = State("s", "Times of the most recent events, as a ring buffer.", size=16)
    count = State("1", "Number of events so far.")
    time = State("s", "Time since the start.")
    steps = State("1", "Steps since the start.")
    inside = State("1", "1 if the signal was on in the last step.")

    value = Metric("1/s", "Inverse of the mean of the last periods.")

    @staticmethod
    def start(p, u, x):
        x.inside = u.signal

    @staticmethod
    def update(p, u, x, y, dt):
        if u.signal > 0.5 and x.inside < 0.5:
            x.times[int(x.count) % 16] = x.time
            x.count = x.count + 1
        x.inside = u.signal
        x.steps = x.steps + 1
        x.time = x.steps * dt

    @staticmethod
    def finish(p, x, m):
        periods = min(int(x.count) - 1, int(p.average))
        m.value = math.nan
        if periods > 0:
            last = x.times[(int(x.count) - 1) % 16]
            first = x.times[(int(x.count) - 1 - periods) % 16]
            m.value = periods / (last - first)
