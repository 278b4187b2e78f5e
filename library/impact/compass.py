import math

from gaitsim.component import Component, Input, Link, Output, Parameter, State

JUST = 1e-9  # rad; tolerance within which a foot below the ground counts as striking it now


class Compass(Component):
    """Heel strike of two straight legs on a slope, without rebound or slip; the other leg leaves the ground at once.

    Two angular momenta are conserved: that of the whole model about the new foot, and that of the trailing leg about
    the hip (Goswami, Thuilot & Espiau 1998). A leg is a point mass at a distance from its foot; the rest of the mass
    is at the hip. With the mass of the legs at their feet, far below that of the hip, it is the simplest walker
    (Garcia et al. 1998). The swing leg passes through the ground at mid-stance.
    """

    leg_mass = Parameter("kg", "Mass m of each leg.", bounds=(1e-9, 1000))
    hip_mass = Parameter("kg", "Mass m_H at the hip.", bounds=(0, 1000))
    length = Parameter("m", "Length of each leg.", bounds=(1e-3, 10))
    mass_height = Parameter("m", "Distance a of a leg's mass from its foot, below the length.", bounds=(0, 10))
    slope = Parameter("rad", "Downward slope of the ground in the forward direction.", bounds=(-1.5, 1.5))
    foothold = Link(
        "The joint at the foot of the stance leg.",
        reads=(("angle", "angle"), ("rate", "velocity"), ("x", "x"), ("z", "z")),
        sends=(
            ("struck", "struck"),
            ("new_angle", "new_angle"),
            ("new_rate", "new_rate"),
            ("new_x", "new_x"),
            ("new_z", "new_z"),
        ),
    )
    hip = Link(
        "The joint between the legs.",
        reads=(("hip_angle", "angle"), ("hip_rate", "velocity")),
        sends=(("struck", "struck"), ("new_angle", "new_hip_angle"), ("new_rate", "new_hip_rate")),
    )
    angle = Input("rad", "Forward lean of the stance leg.")
    rate = Input("rad/s", "Its rate.")
    hip_angle = Input("rad", "Angle of the swing leg from the stance leg, backwards.")
    hip_rate = Input("rad/s", "Its rate.")
    x = Input("m", "Position of the stance foot.")
    z = Input("m", "How high it is.")

    struck_at = State("s", "When the last impact was.")
    speed = State("m/s", "Speed along the slope over the last step.")

    guard = Output("rad", "Rises through 0 when the swing foot strikes the ground ahead.")
    struck = Output("1", "1 in the instant of an impact.")
    half_angle = Output("rad", "Half the angle between the legs, positive with the swing foot ahead.")
    new_angle = Output("rad", "Lean of the new stance leg.")
    new_rate = Output("rad/s", "Rate of the new stance leg after an impact.")
    new_swing_rate = Output("rad/s", "Rate of the new swing leg in space after an impact.")
    new_hip_angle = Output("rad", "Angle of the new swing leg from the new stance leg.")
    new_hip_rate = Output("rad/s", "Its rate after an impact.")
    new_x = Output("m", "Position of the swing foot.")
    new_z = Output("m", "How high it is.")
    step_length = Output("m", "Distance between the feet.")
    step_speed = Output("m/s", "Speed along the slope over the last step.")

    @staticmethod
    def output(p, u, x, y):
        y.half_angle = -0.5 * u.hip_angle
        apart = u.angle + u.hip_angle + u.angle - 2 * p.slope
        # A foot that is behind has just left the ground; it passes through the ground without an impact.
        y.guard = apart if y.half_angle > 0 else abs(apart)
        y.struck = 1.0 if y.half_angle > 0 and 0 <= apart < JUST else 0.0
        y.new_angle = u.angle + u.hip_angle
        y.new_hip_angle = -u.hip_angle
        y.new_x = u.x + p.length * (math.sin(u.angle) - math.sin(y.new_angle))
        y.new_z = u.z + p.length * (math.cos(u.angle) - math.cos(y.new_angle))
        y.step_length = 2 * p.length * abs(math.sin(y.half_angle))
        y.step_speed = x.speed
        # Angular momenta before the impact, about the new foot; ahead: distance of the hip, across the old leg.
        a, b, m = p.mass_height, p.length - p.mass_height, p.leg_mass
        ahead = p.length * math.cos(u.hip_angle)
        hips = p.hip_mass * p.length * ahead
        whole = (hips + m * a * (2 * ahead - b)) * u.rate - m * a * b * (u.rate + u.hip_rate)
        inertia = (p.hip_mass + m) * p.length**2 + m * a**2 - m * ahead**2
        y.new_rate = (whole + m * a * (b - ahead) * u.rate) / inertia
        y.new_swing_rate = (ahead * y.new_rate - a * u.rate) / b
        y.new_hip_rate = y.new_swing_rate - y.new_rate

    @staticmethod
    def reset(p, u, x, y, t):
        x.speed = y.step_length / (t - x.struck_at) if t > x.struck_at else x.speed
        x.struck_at = t
