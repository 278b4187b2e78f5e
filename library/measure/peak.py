import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Peak(Component):
    """The largest value of a signal in each contact (or over the whole run without a gate)."""

    average = Parameter(
        "1",
        "Number of most recent peaks that are averaged.",
        default=3,
        bounds=(1, 16),
        source="thesis: last three",
        whole=True,
    )
    signal = Input("*", "Any signal.")
    gate = Input("1", "1 while peaks are measured; a peak ends when the gate falls to 0.", default=1)

    samples = State("*", "The most recent peaks, as a ring buffer.", size=16)
    count = State("1", "Number of gates that have closed.")
    highest = State("*", "Peak since the gate opened.")
    inside = State("1", "1 if the gate was open in the last step.")
    greatest = State("*", "Peak since the gate opened for the first time.")
    opened = State("1", "1 once the gate has been open.")

    value = Metric("*", "Mean of the last peaks; without a closed gate, the peak of the open one.")
    overall = Metric("*", "Largest value while the gate was open.")

    @staticmethod
    def update(p, u, x, y, dt):
        if u.gate > 0.5:
            x.highest = max(x.highest, u.signal) if x.inside > 0.5 else u.signal
            x.greatest = max(x.greatest, u.signal) if x.opened > 0.5 else u.signal
            x.opened = 1.0
        elif x.inside > 0.5:
            x.samples[int(x.count) % 16] = x.highest
            x.count = x.count + 1
        x.inside = u.gate

    @staticmethod
    def finish(p, x, m):
        count = min(int(x.count), int(p.average))
        total = 0.0 * x.highest
        for i in range(count):
            total = total + x.samples[(int(x.count) - 1 - i) % 16]
        m.overall = x.greatest
        if count:
            m.value = total / count
        else:
            m.value = x.highest if x.inside > 0.5 else math.nan
