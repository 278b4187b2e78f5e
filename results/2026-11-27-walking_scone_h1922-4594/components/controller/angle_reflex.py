from gaitsim.component import Component, Curve, Input, Output, Parameter

from ._reflex import LOWER, UPPER, gated


class AngleReflex(Component):
    """Stimulation from an angle and its rate: S = S_0 + k_p (phi - phi_ref) + k_d phi', clamped and gated.

    In Geyer & Herr (2010) the hip flexors' swing has k_lean (theta - theta_ref) with the trunk's lean at
    take-off as the angle (see controller/sample_hold) and no k_d.
    """

    proportional = Parameter("1/rad", "k_p: stimulation per angle; negative reverses it.", bounds=(-100, 100))
    derivative = Parameter(
        "s/rad",
        "k_d: stimulation per angular velocity.",
        default=0,
        bounds=(-100, 100),
        source="geyer2010, lean at take-off",
    )
    reference = Parameter("rad", "phi_ref: angle at which the reflex adds nothing.", bounds=(-6.3, 6.3))
    bias = Parameter(
        "1",
        "S_0: stimulation at phi_ref.",
        default=0,
        bounds=(-1, 1),
        source="definition: usually added to another reflex that has S_0",
    )
    lower = LOWER
    upper = UPPER
    angle = Input("rad", "Angle of a joint or a segment.")
    angular_velocity = Input("rad/s", "Angular velocity of the same joint or segment.", default=0)
    gate = Input("1", "1 enables the reflex; 0 disables it.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    answer = Curve(
        "stimulation",
        "angle",
        (-0.3, 0.5),
        "Stimulation over the angle, with the paper's gain for the lean at take-off.",
        at={"proportional": 1.15, "reference": 0.105},
    )

    @staticmethod
    def output(p, u, x, y):
        wanted = p.bias + p.proportional * (u.angle - p.reference) + p.derivative * u.angular_velocity
        y.stimulation = gated(wanted, u.gate, p.lower, p.upper)
