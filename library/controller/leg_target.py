from gaitsim.component import Component, Curve, Input, Output, Parameter


class LegTarget(Component):
    """Target angle of a swing leg from the motion of the trunk relative to the other foot (Song & Geyer 2015).

    a = a_0 + c_d d + c_v v in the world, and a + c_theta theta relative to the trunk. d is the distance of the trunk's
    center of mass from the other ankle, v its velocity. In the sagittal plane d and v are positive forwards, a is the
    leg angle, which decreases as the leg moves forwards, and c_theta is -1, because the hip turns with the trunk. In
    the frontal plane d and v are positive outwards, a is the abduction of the hip, and c_theta is 1.
    """

    nominal = Parameter("deg", "a_0: angle at no distance and no velocity.", bounds=(-360, 360))
    distance_gain = Parameter("deg/m", "c_d.", bounds=(-1000, 1000))
    velocity_gain = Parameter("deg s/m", "c_v.", bounds=(-1000, 1000))
    lean_gain = Parameter(
        "1", "c_theta: -1 in the sagittal plane, 1 sideways.", default=-1, bounds=(-1, 1), source="songmodel"
    )
    distance = Input("m", "d.")
    velocity = Input("m/s", "v.")
    lean = Input("rad", "theta: lean of the trunk, forwards or outwards.")
    world_target = Output("rad", "Target angle in the world.")
    target = Output("rad", "Target angle from the trunk.")

    sideways = Curve(
        "target",
        "velocity",
        (-0.3, 0.3),
        "Abduction over the velocity outwards.",
        at={"nominal": -0.5, "distance_gain": 16, "velocity_gain": 19, "lean_gain": 1, "distance": 0.1},
    )

    @staticmethod
    def output(p, u, x, y):
        y.world_target = p.nominal + p.distance_gain * u.distance + p.velocity_gain * u.velocity
        y.target = y.world_target + p.lean_gain * u.lean
