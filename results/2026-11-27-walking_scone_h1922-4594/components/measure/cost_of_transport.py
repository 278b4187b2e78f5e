import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class CostOfTransport(Component):
    """Gross metabolic energy of muscles and basal metabolism, per body mass and distance.

    Each muscle's `metabolics` sends its power here or to a sum of its leg: `to: cost_of_transport.power`.
    """

    mass = Parameter("kg", "Body mass.", bounds=(0.1, 1000))
    rest = Parameter(
        "W/kg",
        "Basal power per body mass, muscles aside; 1.51 W/kg in Wang et al. (2012).",
        default=1.2,
        bounds=(0, 10),
        source="umberger2003: as in OpenSim",
    )
    settle = Parameter(
        "s",
        "Energy and distance are counted from this time on.",
        default=2,
        bounds=(0, 1e3),
        source="definition: two strides",
    )
    power = Input("W", "Metabolic powers of muscles.", sums=True)
    position = Input("m", "Forward position, such as that of the pelvis.")

    steps = State("1", "Steps since the start.")
    time = State("s", "Time of the last position.")
    begin = State("m", "Position where the count begins.")
    begin_time = State("s", "Time at which the count begins.")
    last = State("m", "Last position.")
    energy = State("J", "Energy of all muscles since the count began.")
    before = State("W", "Power one step ago.")

    value = Metric("J/(kg m)", "Gross cost of transport; no value without forward motion.")
    muscles = Metric("J/(kg m)", "The same without basal metabolism.")
    rate = Metric("W/kg", "Gross metabolic power per body mass.")

    @staticmethod
    def start(p, u, x):
        x.begin = u.position
        x.last = u.position
        x.before = u.power

    @staticmethod
    def update(p, u, x, y, dt):
        x.time = x.steps * dt
        if x.time <= p.settle:
            x.begin = u.position
            x.begin_time = x.time
            x.energy = 0.0
        else:
            x.energy = x.energy + 0.5 * (x.before + u.power) * dt
        x.before = u.power
        x.last = u.position
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        lasted, distance = x.time - x.begin_time, x.last - x.begin
        moving = lasted > 0 and distance > 0
        m.rate = p.rest + x.energy / (p.mass * lasted) if lasted > 0 else math.nan
        m.muscles = x.energy / (p.mass * distance) if moving else math.nan
        m.value = m.muscles + p.rest * lasted / distance if moving else math.nan
