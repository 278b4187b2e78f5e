from gaitsim.component import Component, Curve, Input, Output, Parameter


class JointReflex(Component):
    """Stimulation while a joint is beyond an angle and moves further away from it: S = G |phi - phi_off|, gated.

    The knee of Geyer & Herr (2010): the vasti lose k_phi (phi_k - phi_k,off) while phi_k > phi_k,off
    and phi_k' > 0, which is a gain of -k_phi. Where the joint's angle falls as the knee extends,
    direction is -1.
    """

    gain = Parameter("1/rad", "G: stimulation per angle beyond the offset; negative inhibits.", bounds=(-100, 100))
    offset = Parameter("rad", "phi_off: angle at which the reflex begins.", bounds=(-6.3, 6.3))
    direction = Parameter(
        "1",
        "1: acts above the offset while the angle grows; -1: below it while the angle falls.",
        default=1,
        bounds=(-1, 1),
        source="geyer2010, angles that grow in extension",
        whole=True,
    )
    angle = Input("rad", "Angle of the joint.")
    angular_velocity = Input("rad/s", "Its rate.")
    gate = Input("1", "1 enables the reflex; 0 disables it.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    answer = Curve(
        "stimulation",
        "angle",
        (2.6, 3.3),
        "Effect of the paper's knee angle on the vasti, while the knee extends and while it flexes.",
        at={"gain": -2, "offset": 2.97},
        each=("angular_velocity", (1, -1)),
    )

    @staticmethod
    def output(p, u, x, y):
        beyond = p.direction * (u.angle - p.offset)
        leaving = p.direction * u.angular_velocity > 0
        y.stimulation = u.gate * p.gain * beyond if beyond > 0 and leaving else 0.0
