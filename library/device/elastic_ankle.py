from gaitsim.component import Component, Curve, Input, Link, Output, Parameter


class ElasticAnkle(Component):
    """A spring with a damper in place of a joint's muscles: a passive prosthetic ankle-foot.

    M = k (phi_0 - phi) - c phi', with one stiffness k on each side of the slack angle phi_0. At an ankle whose angle
    grows with plantarflexion, `stiffness` acts while the foot is dorsiflexed and `return_stiffness` while it is
    plantarflexed. What the spring takes it gives back; the damper takes c phi'^2.
    """

    stiffness = Parameter("N m/rad", "k at angles below the slack angle.", bounds=(0, 1e5))
    return_stiffness = Parameter("N m/rad", "k at angles above the slack angle.", bounds=(0, 1e5))
    slack_angle = Parameter("deg", "phi_0: angle of the joint at which there is no moment.", bounds=(-360, 360))
    damping = Parameter(
        "N m s/rad", "c: moment per angular velocity.", default=0, bounds=(0, 1e3), source="definition: an ideal spring"
    )
    joint = Link(
        "The joint that the device spans, instead of angle:, angular_velocity: and to:.",
        reads=(("angle", "angle"), ("angular_velocity", "angular_velocity")),
        sends=(("moment", "moment"),),
    )
    angle = Input("rad", "Joint angle.")
    angular_velocity = Input("rad/s", "Angular velocity of the joint.")
    moment = Output("N m", "Moment that makes the joint's angle grow.")
    elastic_energy = Output("J", "Elastic energy of the spring.")
    damping_power = Output("W", "What the damper takes.")

    spring = Curve(
        "moment",
        "angle",
        (1.2, 2),
        "Moment over the ankle's angle at rest, slack at 90 deg.",
        at={"stiffness": 600, "return_stiffness": 100, "slack_angle": 90},
    )

    @staticmethod
    def output(p, u, x, y):
        turned = p.slack_angle - u.angle
        stiffness = p.stiffness if turned > 0 else p.return_stiffness
        y.moment = stiffness * turned - p.damping * u.angular_velocity
        y.elastic_energy = 0.5 * stiffness * turned**2
        y.damping_power = p.damping * u.angular_velocity**2
