import math

from gaitsim.component import Component, Curve, Input, Link, Output, Parameter


class CosineArm(Component):
    """A path around one joint whose moment arm is r = r_0 cos(s (phi - phi_max)), s = 1 in Geyer & Herr (2010).

    l = l_ref - rho r_0 / s [sin(s (phi - phi_max)) - sin(s (phi_ref - phi_max))]: the path shortens as the angle
    increases where r > 0. The pennation factor rho scales the length only, not the moment r F: with rho < 1 the joint
    receives 1 / rho of the muscle's work. With rho = 1 both are equal. phi_max and phi_ref follow the angle convention
    of the joint, and r_0 has the sign of the moment in that convention. Where an arm falls from r_0 to r_min at
    phi_min (Song & Geyer 2015), s = acos(r_min / r_0) / |phi_min - phi_max|.
    """

    moment_arm = Parameter(
        "m", "Largest moment arm r_0; negative if tension decreases the joint angle.", bounds=(-1, 1)
    )
    max_angle = Parameter("rad", "Joint angle phi_max at which the arm is r_0.", bounds=(-6.3, 6.3))
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
    angle_scale = Parameter(
        "1", "s: scale of the angle in the cosine.", default=1, bounds=(1e-3, 10), source="geyer2010"
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

    curve = Curve(
        of="length",
        over="angle",
        span=(1.2, 2.3),
        doc="Length over the joint angle of a soleus: r_0 5 cm, phi_max 110 deg, phi_ref 80 deg.",
        at={
            "moment_arm": 0.05,
            "max_angle": 1.9199,
            "reference_length": 0.3,
            "reference_angle": 1.3963,
            "pennation": 0.5,
        },
    )

    @staticmethod
    def output(p, u, x, y):
        turned = p.angle_scale * (u.angle - p.max_angle)
        arm = p.moment_arm * math.cos(turned)
        change = math.sin(turned) - math.sin(p.angle_scale * (p.reference_angle - p.max_angle))
        y.length = p.reference_length - p.pennation * p.moment_arm * change / p.angle_scale
        y.velocity = -p.pennation * arm * u.angular_velocity
        y.moment = arm * u.tension
