from gaitsim.component import Component, Curve, Input, Link, Output, Parameter


class ConstantArm(Component):
    """A path around one joint at a constant distance, such as the knee extensor of Geyer et al. (2003).

    With d > 0 the path shortens as the joint angle increases: l = l_ref - rho d (phi - phi_ref). The pennation
    factor rho scales the length only, not the moment d F (Geyer & Herr 2010): with rho < 1 the joint
    receives 1 / rho of the muscle's work. With rho = 1 both are equal.
    """

    moment_arm = Parameter("m", "Moment arm d; negative if tension decreases the joint angle.", bounds=(-1, 1))
    reference_length = Parameter(
        "m",
        "Length l_ref at the reference angle; by default the sum of optimal fiber length and tendon slack length.",
        bounds=(0, 3),
    )
    reference_angle = Parameter("rad", "Joint angle phi_ref.", bounds=(-6.3, 6.3))
    pennation = Parameter(
        "1",
        "rho: change of the fiber's length per change of the path's.",
        default=1,
        bounds=(0, 1),
        source="definition: fibers along the path",
    )
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
        (1, 3.14),
        "Length over the angle, arm 4 cm.",
        at={"moment_arm": 0.04, "reference_length": 0.5, "reference_angle": 1.92},
    )
    moments = Curve(
        "moment",
        "angle",
        (1, 3.14),
        "Moment over the angle at 1 kN: the arm is constant.",
        at={"moment_arm": 0.04, "reference_length": 0.5, "reference_angle": 1.92, "tension": 1000},
    )

    @staticmethod
    def output(p, u, x, y):
        y.length = p.reference_length - p.pennation * p.moment_arm * (u.angle - p.reference_angle)
        y.velocity = -p.pennation * p.moment_arm * u.angular_velocity
        y.moment = p.moment_arm * u.tension
