from gaitsim.component import Component, Curve, Input, Link, Output, Parameter


class PolynomialArm(Component):
    """A path around one joint whose moment arm is a polynomial of the angle, and whose length is the arm's integral.

    r = r_0 + r_1 a + r_2 a^2 + r_3 a^3 with a = phi - phi_ref, and l = l_ref - integral of r over a. The path
    therefore neither creates nor absorbs work; pennation belongs to the muscle. The path shortens as the angle
    increases where r > 0.
    """

    moment_arm = Parameter(
        "m", "r_0: arm at the reference angle; negative if tension decreases the joint angle.", bounds=(-1, 1)
    )
    arm_slope = Parameter(
        "m/rad", "r_1: slope of the arm.", default=0, bounds=(-10, 10), source="definition: a constant arm"
    )
    arm_curvature = Parameter(
        "m/rad^2",
        "r_2: quadratic coefficient of the arm.",
        default=0,
        bounds=(-10, 10),
        source="definition: a constant arm",
    )
    arm_cubic = Parameter(
        "m/rad^3",
        "r_3: cubic coefficient of the arm.",
        default=0,
        bounds=(-10, 10),
        source="definition: a constant arm",
    )
    reference_length = Parameter(
        "m",
        "Length l_ref at the reference angle; by default the sum of optimal fiber length and tendon slack length.",
        bounds=(0, 3),
    )
    reference_angle = Parameter("rad", "Joint angle phi_ref.", bounds=(-6.3, 6.3))
    joint = Link(
        "The joint that the path crosses; replaces angle:, angular_velocity: and to:.",
        reads=(("angle", "angle"), ("angular_velocity", "angular_velocity")),
        sends=(("moment", "moment"),),
    )
    angle = Input("rad", "Joint angle.")
    angular_velocity = Input("rad/s", "Angular velocity of the joint.")
    tension = Input("N", "Force along the path, positive in tension.", sums=True)
    length = Output("m", "Length of the path.")
    velocity = Output("m/s", "Lengthening velocity of the path.")
    moment = Output("N m", "Moment in the direction of increasing joint angle.")

    lengths = Curve(
        "length",
        "angle",
        (0, 2),
        "Length over the angle, arm 4 cm at 60 deg and 1 cm less per radian beyond.",
        at={"moment_arm": 0.04, "arm_slope": -0.01, "reference_length": 0.5, "reference_angle": 1.0472},
    )
    moments = Curve(
        "moment",
        "angle",
        (0, 2),
        "Moment over the angle at 1 kN, the same path.",
        at={
            "moment_arm": 0.04,
            "arm_slope": -0.01,
            "reference_length": 0.5,
            "reference_angle": 1.0472,
            "tension": 1000,
        },
    )

    @staticmethod
    def output(p, u, x, y):
        a = u.angle - p.reference_angle
        arm = p.moment_arm + a * (p.arm_slope + a * (p.arm_curvature + a * p.arm_cubic))
        rest = p.arm_slope / 2 + a * (p.arm_curvature / 3 + a * p.arm_cubic / 4)
        y.length = p.reference_length - a * (p.moment_arm + a * rest)
        y.velocity = -arm * u.angular_velocity
        y.moment = arm * u.tension
