import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class ContactTime(Component):
    """Duration of contacts."""

    average = Parameter(
        "1",
        "Number of most recent contacts that are averaged.",
        default=3,
        bounds=(1, 16),
        source="thesis: last three",
        whole=True,
    )
    contact = Input("1", "1 in contact, else 0.")

    samples = State("s", "The most recent durations, as a ring buffer.", size=16)
    count = State("1", "Number of contacts that have ended.")
    duration = State("s", "Duration of the present contact.")
    seen = State("1", "1 once the first touchdown has been seen; a contact cut by the start is not counted.")
    inside = State("1", "1 if the last step was in contact.")

    value = Metric("s", "Mean of the last durations.")
    contacts = Metric("1", "Number of contacts that ended.")

    @staticmethod
    def start(p, u, x):
        x.inside = u.contact

    @staticmethod
    def update(p, u, x, y, dt):
        if u.contact > 0.5:
            if x.inside < 0.5:
                x.seen = 1.0
                x.duration = 0.0
            x.duration = x.duration + dt
        elif x.inside > 0.5 and x.seen > 0.5:
            x.samples[int(x.count) % 16] = x.duration
            x.count = x.count + 1
        x.inside = u.contact

    @staticmethod
    def finish(p, x, m):
        count = min(int(x.count), int(p.average))
        total = 0.0
        for i in range(count):
            total = total + x.samples[(int(x.count) - 1 - i) % 16]
        m.contacts = x.count
        m.value = total / count if count else math.nan
