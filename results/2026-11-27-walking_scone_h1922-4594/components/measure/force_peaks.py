import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class ForcePeaks(Component):
    """The two peaks of the vertical force of a leg in stance, and the trough between them.

    The first peak lies in the first half of a stance, the second in the second. A stance has two
    peaks if the force between them falls by at least `depth` below both.
    """

    settle = Parameter(
        "s", "Stances that begin earlier do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    threshold = Parameter(
        "1",
        "Load above which the foot is loaded.",
        default=0.05,
        bounds=(0, 1),
        source="definition: 5 % of body weight",
    )
    depth = Parameter(
        "1", "Depth of a trough between peaks.", default=0.02, bounds=(0, 1), source="definition: 2 % of body weight"
    )
    load = Input("1", "Vertical ground reaction force of the leg in body weights.")
    stance = Input("1", "1 while the leg stands, such as {from: stance_r.in_stance}.")

    # One sample every `every` steps; when the array is full, every second sample is dropped and `every` doubles.
    samples = State("1", "Force of the present stance.", size=256)
    filled = State("1", "Number of samples.")
    loaded = State("1", "Number of samples when the foot was last loaded.")
    every = State("1", "Steps from one sample to the next.")
    since = State("1", "Steps since the last sample.")
    steps = State("1", "Steps since the start.")
    before = State("1", "Whether the leg stood in the last step.")
    counting = State("1", "1 in a stance that counts.")
    firsts = State("1", "Sum of first peaks.")
    seconds = State("1", "Sum of second peaks.")
    troughs = State("1", "Sum of the lowest forces between the peaks.")
    pairs = State("1", "Number of stances with two peaks.")
    count = State("1", "Number of stances that count.")
    greatest = State("1", "Largest force of all stances.")

    value = Metric("1", "Largest force of all stances, in body weights.")
    first = Metric("1", "Mean first peak.")
    second = Metric("1", "Mean second peak.")
    trough = Metric("1", "Mean lowest force between the peaks.")
    two_peaks = Metric("1", "Share of stances that have two peaks.")

    @staticmethod
    def start(p, u, x):
        x.before = u.stance

    @staticmethod
    def update(p, u, x, y, dt):
        if x.before > 0.5 and u.stance < 0.5 and x.counting > 0.5:
            half = int(x.loaded) // 2
            one, two = 0, half
            for i in range(int(x.loaded)):
                if i < half and x.samples[i] > x.samples[one]:
                    one = i
                if i >= half and x.samples[i] > x.samples[two]:
                    two = i
            least = x.samples[two]
            for i in range(one, two):
                least = min(least, x.samples[i])
            low = min(x.samples[one], x.samples[two])
            x.firsts = x.firsts + x.samples[one]
            x.seconds = x.seconds + x.samples[two]
            x.troughs = x.troughs + least
            x.pairs = x.pairs + (1.0 if low - least >= p.depth else 0.0)
            x.greatest = max(x.greatest, max(x.samples[one], x.samples[two]))
            x.count = x.count + 1
        if u.stance < 0.5 and u.load <= p.threshold:
            # In swing: the next contact may begin a stance that counts.
            x.filled = 0.0
            x.loaded = 0.0
            x.every = 1.0
            x.since = 0.0
            x.counting = 1.0 if x.steps * dt >= p.settle else 0.0
        else:
            if x.since < 0.5:
                if x.filled > 255.5:
                    for i in range(128):
                        x.samples[i] = x.samples[2 * i]
                    x.filled = 128.0
                    x.loaded = math.ceil(0.5 * x.loaded)
                    x.every = 2 * x.every
                x.samples[int(x.filled) % 256] = u.load
                x.filled = x.filled + 1
                x.since = x.every
            x.since = x.since - 1
            if u.load > p.threshold:
                x.loaded = x.filled
        x.before = u.stance
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = x.greatest if x.count > 0 else math.nan
        m.first = x.firsts / x.count if x.count > 0 else math.nan
        m.second = x.seconds / x.count if x.count > 0 else math.nan
        m.trough = x.troughs / x.count if x.count > 0 else math.nan
        m.two_peaks = x.pairs / x.count if x.count > 0 else math.nan
