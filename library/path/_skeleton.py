from gaitsim.component import Component, Curve, Input, Output, Parameter


class Skeleton(Component):
    """A path around one joint at a distance d from its axis, l = l_0 - d phi; replace it by your equations."""

    moment_arm = Parameter("m", "d: moment arm.", default=0.04, bounds=(-1, 1), source="geyer2003")
    straight_length = Parameter("m", "l_0: length at the angle 0.", default=0.5, bounds=(0, 3), source="geyer2003")
    angle = Input("rad", "Joint angle.")
    angular_velocity = Input("rad/s", "Angular velocity of the joint.", default=0)
    tension = Input("N", "Force along the path, positive in tension.", sums=True)
    length = Output("m", "Length of the path.")
    velocity = Output("m/s", "Lengthening velocity of the path.")
    moment = Output("N m", "Moment in the direction of increasing joint angle; connect it to the joint with to:.")

    lengths = Curve("length", "angle", (-1.5, 1.5), "Length over the angle.")
    moments = Curve("moment", "tension", (0, 1000), "Moment over the force; its slope is the arm.")

    @staticmethod
    def output(p, u, x, y):
        y.length = p.straight_length - p.moment_arm * u.angle
        y.velocity = -p.moment_arm * u.angular_velocity
        y.moment = p.moment_arm * u.tension
