import math

from gaitsim.component import Component, Curve, Input, Output, Parameter


class HipAssist(Component):
    """A hip exoskeleton with delayed output feedback: M = k (sin phi - sin phi_other), both delayed, limited.

    The law of Lim et al. (2019). phi is the hip's angle from upright standing. The delay belongs to the
    connections: `angle: {from: leg_l.hip.angle, delay: 250 ms}`. A negative k moves each leg towards the other one.
    """

    gain = Parameter("N m", "k: gain.", bounds=(-1e3, 1e3))
    neutral = Parameter("deg", "Angle of the hip when standing upright.", bounds=(-360, 360))
    limit = Parameter("N m", "Largest moment of the motor.", bounds=(0, 1e3))
    angle = Input("rad", "Angle of this hip.")
    opposite_angle = Input("rad", "Angle of the other hip.")
    moment = Output("N m", "Moment in the direction of increasing joint angle.")

    law = Curve(
        "moment",
        "angle",
        (2.4, 3.8),
        "Moment over the hip's angle; the other hip is upright.",
        at={"gain": 10, "neutral": 180, "limit": 5, "opposite_angle": 3.14159},
    )

    @staticmethod
    def output(p, u, x, y):
        apart = math.sin(u.angle - p.neutral) - math.sin(u.opposite_angle - p.neutral)
        y.moment = max(-p.limit, min(p.limit, p.gain * apart))
