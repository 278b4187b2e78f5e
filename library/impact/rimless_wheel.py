import math

from gaitsim.component import Component, Input, Link, Output, Parameter, State


class RimlessWheel(Component):
    """The next spoke of a rimless wheel strikes a slope, without rebound or slip (McGeer 1990).

    The angular momentum about the new foothold is conserved: with spokes of length l that are 2 a apart, a mass m and
    an inertia I about the hub, the rate is multiplied by (I + m l^2 cos 2a) / (I + m l^2).
    """

    spokes = Parameter("1", "Number of spokes.", bounds=(3, 100), whole=True)
    length = Parameter("m", "Length of a spoke l.", bounds=(1e-3, 10))
    mass = Parameter("kg", "Mass m.", bounds=(1e-6, 1000))
    inertia = Parameter("kg m^2", "Moment of inertia I about the hub.", bounds=(0, 1000))
    slope = Parameter("rad", "Downward slope of the ground in the forward direction.", bounds=(-1.5, 1.5))
    foothold = Link(
        "The joint of the standing spoke.",
        reads=(("angle", "angle"), ("rate", "velocity"), ("x", "x"), ("z", "z")),
        sends=(
            ("struck", "struck"),
            ("new_angle", "new_angle"),
            ("new_rate", "new_rate"),
            ("new_x", "new_x"),
            ("new_z", "new_z"),
        ),
    )
    angle = Input("rad", "Forward lean of the standing spoke.")
    rate = Input("rad/s", "Its rate.")
    x = Input("m", "Position of its foothold.")
    z = Input("m", "Height of its foothold.")

    struck_at = State("s", "When the last impact was.")
    speed = State("m/s", "Speed along the slope over the last step.")

    guard = Output("rad", "Rises through 0 when the next spoke strikes.")
    struck = Output("1", "1 in the instant of an impact.")
    new_angle = Output("rad", "Lean of the next spoke.")
    new_rate = Output("rad/s", "Rate after an impact at this rate.")
    new_x = Output("m", "Position of the next foothold.")
    new_z = Output("m", "Height of the next foothold.")
    step_length = Output("m", "Distance between two footholds.")
    step_speed = Output("m/s", "Speed along the slope over the last step.")

    @staticmethod
    def output(p, u, x, y):
        half = math.pi / p.spokes
        y.guard = u.angle - p.slope - half
        y.struck = 1.0 if y.guard >= 0 else 0.0
        y.new_angle = u.angle - 2 * half
        about = p.mass * p.length**2
        y.new_rate = u.rate * (p.inertia + about * math.cos(2 * half)) / (p.inertia + about)
        y.new_x = u.x + p.length * (math.sin(u.angle) - math.sin(y.new_angle))
        y.new_z = u.z + p.length * (math.cos(u.angle) - math.cos(y.new_angle))
        y.step_length = 2 * p.length * math.sin(half)
        y.step_speed = x.speed

    @staticmethod
    def reset(p, u, x, y, t):
        x.speed = y.step_length / (t - x.struck_at) if t > x.struck_at else x.speed
        x.struck_at = t
