import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Apex(Component):
    """Apex heights between contacts, above a reference height."""

    reference = Parameter(
        "m", "Height that counts as zero.", default=0, bounds=(-100, 100), source="definition: the ground"
    )
    average = Parameter(
        "1",
        "Number of most recent apexes that are averaged.",
        default=3,
        bounds=(1, 16),
        source="thesis: last three",
        whole=True,
    )
    height = Input("m", "Height whose apexes are measured.")
    airborne = Input("1", "1 where an apex may be, 0 in contact.", default=1)

    samples = State("m", "The most recent apexes, as a ring buffer.", size=16)
    count = State("1", "Number of apexes so far.")
    before = State("m", "Height one step ago.")
    rising = State("1", "1 if the height rose in the last step.")

    value = Metric("m", "Mean of the last apexes above the reference.")
    spread = Metric("m", "Highest minus lowest of them.")
    hops = Metric("1", "Number of all apexes.")

    @staticmethod
    def start(p, u, x):
        x.before = u.height

    @staticmethod
    def update(p, u, x, y, dt):
        if x.rising > 0.5 and u.height <= x.before and u.airborne > 0.5:
            x.samples[int(x.count) % 16] = x.before - p.reference
            x.count = x.count + 1
        x.rising = 1.0 if u.height > x.before else 0.0
        x.before = u.height

    @staticmethod
    def finish(p, x, m):
        count = min(int(x.count), int(p.average))
        total, highest, lowest = 0.0, -math.inf, math.inf
        for i in range(count):
            sample = x.samples[(int(x.count) - 1 - i) % 16]
            total = total + sample
            highest = max(highest, sample)
            lowest = min(lowest, sample)
        m.hops = x.count
        m.value = total / count if count else math.nan
        m.spread = highest - lowest if count else math.nan
