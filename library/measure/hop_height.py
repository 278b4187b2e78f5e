import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class HopHeight(Component):
    """Height of each apex of the hip above its height at the next touchdown.

    A hop is an apex in flight and the touchdown that follows, with a minimum height between them, so
    that a bouncing contact does not count. A leg with mass bends in flight, so the height of the hip at
    touchdown differs from hop to hop and is measured each time.
    """

    average = Parameter(
        "1",
        "Number of most recent hops that are averaged.",
        default=3,
        bounds=(1, 16),
        source="definition: enough to show a trend",
        whole=True,
    )
    least_height = Parameter(
        "m",
        "Smaller hops are not counted.",
        default=0.005,
        bounds=(0, 1),
        source="definition: a bouncing contact is no hop",
    )
    height = Input("m", "Height of the hip.")
    contact = Input("1", "1 in contact with the ground, else 0.")

    heights = State("m", "Heights of the most recent hops, as a ring buffer.", size=16)
    apexes = State("m", "Heights of the hip at the apexes.", size=16)
    count = State("1", "Number of hops so far.")
    apex = State("m", "The apex whose touchdown has not come yet.")
    waiting = State("1", "1 while there is such an apex.")
    rising = State("1", "1 if the hip rose in the last step.")
    before = State("m", "Height of the hip one step ago.")
    inside = State("1", "1 if the last step was in contact.")
    landed = State("1", "1 from the first touchdown on.")
    landing = State("m", "Height of the hip at the last touchdown of a hop, or at the first.")
    lowest = State("m", "Least height of the hip since the first touchdown.")
    rise = State("m", "Largest rise above the lowest height so far.")

    value = Metric("m", "Mean height of the last hops: apex above touchdown.")
    spread = Metric("m", "Highest minus lowest of their apexes.")
    hops = Metric("1", "Number of hops.")
    apex_height = Metric("m", "Mean height of the hip at the last apexes.")
    touchdown = Metric("m", "Height of the hip at the last touchdown.")
    rebound = Metric("1", "Rise of the hip after the first touchdown in units of its fall since then; at most 1.")

    @staticmethod
    def start(p, u, x):
        x.before = u.height
        x.inside = u.contact

    @staticmethod
    def update(p, u, x, y, dt):
        if u.contact > 0.5 and x.inside < 0.5:
            if x.landed < 0.5:
                x.landed = 1.0
                x.landing = u.height
                x.lowest = u.height
            if x.waiting > 0.5 and x.apex - u.height >= p.least_height:
                x.heights[int(x.count) % 16] = x.apex - u.height
                x.apexes[int(x.count) % 16] = x.apex
                x.count = x.count + 1
                x.landing = u.height
            x.waiting = 0.0
        if x.landed > 0.5:
            x.lowest = min(x.lowest, u.height)
            x.rise = max(x.rise, u.height - x.lowest)
            if x.rising > 0.5 and u.height <= x.before and u.contact < 0.5:
                x.apex = x.before
                x.waiting = 1.0
        x.rising = 1.0 if u.height > x.before else 0.0
        x.before = u.height
        x.inside = u.contact

    @staticmethod
    def finish(p, x, m):
        count = min(int(x.count), int(p.average))
        height, apex = 0.0 * x.apex, 0.0 * x.apex
        highest, lowest = -math.inf, math.inf
        for i in range(count):
            place = (int(x.count) - 1 - i) % 16
            height = height + x.heights[place]
            apex = apex + x.apexes[place]
            highest = max(highest, x.apexes[place])
            lowest = min(lowest, x.apexes[place])
        m.hops = x.count
        m.value = height / count if count else math.nan
        m.apex_height = apex / count if count else math.nan
        m.spread = highest - lowest if count else math.nan
        m.touchdown = x.landing if x.landed > 0.5 else math.nan
        fall = x.landing - x.lowest
        m.rebound = min(1.0, x.rise / fall) if fall > 0 else 0.0
