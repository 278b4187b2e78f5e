import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class LegSpring(Component):
    """Stiffness of a running leg as a spring, from the largest force of each contact (McMahon & Cheng 1990).

    Vertical stiffness: the largest force over the descent of the center of mass from touchdown to its lowest point.
    Leg stiffness: the largest force over the compression of the leg, which is that descent + l_0 (1 - cos a), where
    the leg sweeps an angle of a to either side while the body moves by 2 l_0 sin a. A contact is the time from the
    first load to the last in a stance.
    """

    settle = Parameter(
        "s", "Contacts that begin earlier do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    threshold = Parameter(
        "1",
        "Load above which the foot is loaded.",
        default=0.05,
        bounds=(0, 1),
        source="definition: 5 % of body weight",
    )
    leg_length = Parameter("m", "l_0: length of the leg at touchdown.", bounds=(0.01, 10))
    mass = Parameter("kg", "Mass of the body.", bounds=(1e-3, 1e4))
    gravity = Parameter("m/s^2", "Gravity.", default=9.81, bounds=(0.1, 100), source="definition: standard gravity")
    load = Input("1", "Vertical force on the leg in body weights.")
    stance = Input("1", "1 while the leg stands, such as {from: stance_r.in_stance}.")
    forward = Input("m", "Forward position of the center of mass.")
    height = Input("m", "Its height.")

    steps = State("1", "Steps since the start.")
    inside = State("1", "1 from the first load of a stance on.")
    counting = State("1", "1 in a contact that counts.")
    begun = State("s", "Time at which the contact began.")
    ended = State("s", "Time at which the foot was last loaded.")
    top = State("m", "Height of the center of mass at the beginning.")
    bottom = State("m", "Its lowest height since then.")
    origin = State("m", "Its forward position at the beginning.")
    reached = State("m", "Its forward position when the foot was loaded last.")
    peak = State("1", "Largest force of the contact.")
    count = State("1", "Contacts that count.")
    stiffnesses = State("N/m", "Sum of leg stiffnesses.")
    verticals = State("N/m", "Sum of vertical stiffnesses.")
    compressions = State("m", "Sum of compressions.")
    falls = State("m", "Sum of the descents of the center of mass.")
    durations = State("s", "Sum of durations.")

    value = Metric("kN/m", "Leg stiffness, mean over contacts.")
    vertical = Metric("kN/m", "Vertical stiffness, mean over contacts.")
    compression = Metric("cm", "Compression of the leg.")
    fall = Metric("cm", "Descent of the center of mass from touchdown to its lowest point.")
    contact_time = Metric("s", "Duration of a contact.")

    @staticmethod
    def update(p, u, x, y, dt):
        loaded = u.load > p.threshold
        if u.stance < 0.5 and not loaded:
            sweep = 0.5 * (x.reached - x.origin) / p.leg_length
            fall = x.top - x.bottom
            if x.inside > 0.5 and x.counting > 0.5 and fall > 0 and abs(sweep) < 1:
                compression = fall + p.leg_length * (1 - math.sqrt(1 - sweep * sweep))
                force = x.peak * p.mass * p.gravity
                x.stiffnesses = x.stiffnesses + force / compression
                x.verticals = x.verticals + force / fall
                x.compressions = x.compressions + compression
                x.falls = x.falls + fall
                x.durations = x.durations + x.ended - x.begun
                x.count = x.count + 1
            x.inside = 0.0
        if loaded and x.inside < 0.5:
            x.inside = 1.0
            x.begun = x.steps * dt
            x.counting = 1.0 if x.begun >= p.settle else 0.0
            x.top = u.height
            x.bottom = u.height
            x.origin = u.forward
            x.peak = 0.0
        if loaded:
            x.peak = max(x.peak, u.load)
            x.bottom = min(x.bottom, u.height)
            x.reached = u.forward
            x.ended = (x.steps + 1) * dt
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = x.stiffnesses / x.count if x.count > 0 else math.nan
        m.vertical = x.verticals / x.count if x.count > 0 else math.nan
        m.compression = x.compressions / x.count if x.count > 0 else math.nan
        m.fall = x.falls / x.count if x.count > 0 else math.nan
        m.contact_time = x.durations / x.count if x.count > 0 else math.nan
