import math

from gaitsim.component import Component, Input, Output, Parameter


def bounded(value, limit):
    """As it is up to half of the limit, then ever slower towards the limit: continuous with its slope."""
    half = 0.5 * limit
    return value if value <= half else limit - half * half / value


class Walk(Component):
    """A walk in stages; a candidate in a later stage beats every one in an earlier stage.

    200 to 300, it falls or does not get on, as one that stands still: the cost sinks with the time it
    walked, which is the time upright, but not more than the distance takes at the target speed. Who
    is upright for more than twice that time does not get on. 100 to 200, it does not fall, but its
    speed is not within the tolerance: the cost sinks with the distance to it. 0 to 100, it walks: cost
    of transport in J/(kg m), plus what joints lean on their stops, what the feet strike the ground
    with, and any further terms; as it is up to 50, and slower above so that it stays below 100.
    """

    speed_target = Parameter("m/s", "Speed that is wanted.", default=1.3, bounds=(0.01, 10), source="geyer2010")
    speed_tolerance = Parameter(
        "m/s", "Speeds this near are as good.", default=0.1, bounds=(0, 10), source="definition: 1.2 to 1.4 m/s"
    )
    patience = Parameter(
        "s",
        "Time walked after which half of the cost of a fall is gone.",
        default=5,
        bounds=(1e-3, 1e4),
        source="definition: some steps",
    )
    transport_weight = Parameter(
        "kg m/J", "Cost of 1 J/(kg m).", default=1, bounds=(0, 1e6), source="definition: the unit of the last stage"
    )
    torque_weight = Parameter(
        "1/(N m)",
        "Cost of 1 N m on the stops, in the mean over time.",
        default=0.1,
        bounds=(0, 1e6),
        source="definition: 10 N m on the stops are worth 1 J/(kg m)",
    )
    torque_threshold = Parameter(
        "N m", "Torque on the stops that costs nothing.", default=0, bounds=(0, 1e4), source="definition: none"
    )
    load_weight = Parameter(
        "1",
        "Cost of one body weight too much, in the mean over time.",
        default=10,
        bounds=(0, 1e6),
        source="definition: 0.1 body weights too much all the time are worth 1 J/(kg m)",
    )
    fall_time = Input("s", "How long it stayed up, from measure/fall.")
    fell = Input("1", "1 if it fell, from measure/fall.")
    distance = Input("m", "Distance covered, from measure/speed.")
    speed = Input("m/s", "Mean speed, from measure/speed.")
    cost_of_transport = Input("J/(kg m)", "Metabolic energy for a kilogram and a metre.")
    limit_torque = Input("N m", "Torque on the stops of all joints, in the mean over time.", default=0)
    load_excess = Input("1", "Force on the feet above what is allowed, from measure/load_limit.", default=0)
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
