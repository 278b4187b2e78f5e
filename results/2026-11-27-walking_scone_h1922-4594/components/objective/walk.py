import math

from gaitsim.component import Component, Input, Output, Parameter


def bounded(value, limit):
    """Identity up to half of the limit, then saturating towards the limit; value and slope are continuous."""
    half = 0.5 * limit
    return value if value <= half else limit - half * half / value


class Walk(Component):
    """Cost of walking in stages; every candidate of a later stage is better than those of earlier stages.

    200 to 300: it falls or makes no progress. The cost decreases with the time walked, which is the time
    upright, but at most the time that the distance takes at the target speed. A model that is upright for
    more than twice that time makes no progress. 100 to 200: it does not fall, but its speed is outside the
    tolerance. The cost decreases with the distance to the tolerance. 0 to 100: it walks. The cost is the cost of
    transport in J/(kg m), plus terms for the torque of joint stops, for too large ground forces, and any
    further terms; it is linear up to 50 and saturates towards 100.
    """

    speed_target = Parameter("m/s", "Speed that is wanted.", default=1.3, bounds=(0.01, 10), source="geyer2010")
    speed_tolerance = Parameter(
        "m/s",
        "Speeds within this distance are equally good.",
        default=0.1,
        bounds=(0, 10),
        source="definition: 1.2 to 1.4 m/s",
    )
    patience = Parameter(
        "s",
        "Time walked after which the cost of a fall has halved.",
        default=5,
        bounds=(1e-3, 1e4),
        source="definition: some steps",
    )
    transport_weight = Parameter(
        "kg m/J", "Cost of 1 J/(kg m).", default=1, bounds=(0, 1e6), source="definition: the unit of the last stage"
    )
    torque_weight = Parameter(
        "1/(N m)",
        "Cost of 1 N m on the stops, averaged over time.",
        default=0.1,
        bounds=(0, 1e6),
        source="definition: 10 N m on the stops are worth 1 J/(kg m)",
    )
    torque_threshold = Parameter(
        "N m", "Torque on the stops that costs nothing.", default=0, bounds=(0, 1e4), source="definition: none"
    )
    load_weight = Parameter(
        "1",
        "Cost of an average excess of one body weight.",
        default=10,
        bounds=(0, 1e6),
        source="definition: a constant excess of 0.1 body weights is worth 1 J/(kg m)",
    )
    fall_time = Input("s", "Time until the fall, from measure/fall.")
    fell = Input("1", "1 if it fell, from measure/fall.")
    distance = Input("m", "Distance covered, from measure/speed.")
    speed = Input("m/s", "Mean speed, from measure/speed.")
    cost_of_transport = Input("J/(kg m)", "Metabolic energy per body mass and distance.")
    limit_torque = Input("N m", "Torque on the stops of all joints, averaged over time.", default=0)
    load_excess = Input("1", "Force on the feet above the allowed one, from measure/load_limit.", default=0)
    terms = Input("1", "Costs of further terms, counted in the last stage.", sums=True)
    cost = Output("1", "The cost.")

    @staticmethod
    def output(p, u, x, y):
        miss = abs(u.speed - p.speed_target) - p.speed_tolerance
        walked = min(u.fall_time, max(0.0, u.distance) / p.speed_target)
        if u.fell > 0.5 or walked < 0.5 * u.fall_time:
            y.cost = 200 + 100 * p.patience / (p.patience + walked)
        elif miss > 0:
            y.cost = 100 + 100 * miss / (miss + p.speed_target)
        elif math.isnan(miss):
            y.cost = 200.0
        else:
            torque = 0.0 if u.limit_torque <= p.torque_threshold else u.limit_torque - p.torque_threshold
            extra = p.torque_weight * torque + p.load_weight * u.load_excess + u.terms
            cost = p.transport_weight * u.cost_of_transport + extra
            y.cost = bounded(cost, 100.0) if math.isfinite(cost) else 100.0
