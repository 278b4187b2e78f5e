from gaitsim.component import Component, Input, Output, Parameter


class ConstantArm(Component):
    """A path around one joint at a constant distance, such as the knee extensor of Geyer et al. (2003).

    Opening the joint shortens the path: l = l_ref - d (phi - phi_ref).
    """

    moment_arm = Parameter("m", "Distance d of the path from the joint's axis.", bounds=(-1, 1))
    reference_length = Parameter("m", "Length l_ref at the reference angle.", bounds=(0, 3))
    reference_angle = Parameter("rad", "Joint angle phi_ref.", bounds=(-6.3, 6.3))
    angle = Input("rad", "Joint angle.")
    angular_velocity = Input("rad/s", "Angular velocity of the joint.", default=0)
    tension = Input("N", "Force along the path, positive in tension.", sums=True)
    length = Output("m", "Length of the path.")
    velocity = Output("m/s", "Lengthening velocity of the path.")
    moment = Output("N m", "Moment that opens the joint.")

    @staticmethod
    def output(p, u, x, y):
        y.length = p.reference_length - p.moment_arm * (u.angle - p.reference_angle)
        y.velocity = -p.moment_arm * u.angular_velocity
        y.moment = p.moment_arm * u.tension
