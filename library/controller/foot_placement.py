import math

from gaitsim.component import Component, Curve, Input, Output, Parameter


class FootPlacement(Component):
    """Where a hopper sets its foot down: x_f = v T_s/2 + k (v - v_d) ahead of the hip (Raibert 1986).

    A foot in the middle of the way that the hip makes during stance leaves the speed v as it is: the neutral
    point, v T_s/2, with T_s of the stance before. A foot ahead of it brakes, one behind it accelerates. The leg
    points there, at most 30 deg from the vertical.
    """

    speed = Input("m/s", "v_d: the speed that is asked for.")
    gain = Parameter("s", "k: place of the foot over error of the speed.", bounds=(0, 10))
    velocity = Input("m/s", "v: forward velocity of the hip.")
    contact_time = Input("s", "T_s: how long the last stance took.")
    leg_length = Input("m", "Length of the leg in the air.")
    place = Output("m", "x_f: how far the foot is ahead of the hip.")
    touchdown_angle = Output("rad", "Angle of the leg to the ground; below 90 deg the foot is ahead.")

    law = Curve(
        "place",
        "velocity",
        (-1, 3),
        "Place of the foot over the speed; 1 m/s is asked for.",
        at={"speed": 1, "gain": 0.1, "contact_time": 0.3, "leg_length": 1},
    )

    @staticmethod
    def output(p, u, x, y):
        y.place = 0.5 * u.velocity * u.contact_time + p.gain * (u.velocity - u.speed)
        cosine = max(-0.5, min(0.5, y.place / u.leg_length))
        y.touchdown_angle = math.acos(cosine)
