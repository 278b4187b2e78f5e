from gaitsim.component import Component, Curve, Input, Output, Parameter


class TrunkBalance(Component):
    """Keeps the trunk at a reference lean by the hip muscles of the loaded leg (Geyer & Herr 2010).

    E = c k_p (theta - theta_ref) + k_d theta', times k_bw |F_ipsi|: its positive part extends the hip
    (hamstrings, glutei), the magnitude of its negative part flexes it (hip flexors).
    """

    proportional = Parameter("1/rad", "k_p: stimulation per lean.", default=1.91, bounds=(0, 100), source="geyer2010")
    share = Parameter(
        "1",
        "c: factor of k_p; 0.68 for the glutei of Geyer & Herr.",
        default=1,
        bounds=(0, 10),
        source="geyer2010, hamstrings and hip flexors",
    )
    derivative = Parameter(
        "s/rad", "k_d: stimulation per rate of the lean.", default=0.25, bounds=(0, 100), source="geyer2010"
    )
    reference = Parameter(
        "rad",
        "theta_ref: lean at which the reflex adds nothing.",
        default=0.105,
        bounds=(-1.6, 1.6),
        source="geyer2010",
    )
    load_gain = Parameter(
        "1", "k_bw: effect per body weight on the leg.", default=1.2, bounds=(0, 10), source="geyer2010"
    )
    pitch = Input("rad", "Lean of the trunk, theta; forwards is positive.")
    pitch_rate = Input("rad/s", "Rate of the lean.")
    load = Input("1", "Load on the leg in body weights, |F_ipsi|.")
    gate = Input("1", "1 enables the reflex; 0 disables it.", default=1)
    forward = Output("1", "Stimulation against a forward lean, for muscles that extend the hip.")
    backward = Output("1", "Stimulation against a backward lean, for muscles that flex the hip.")

    against_forward = Curve(
        "forward", "pitch", (-0.3, 0.5), "On hip extensors, over the lean.", at={"load": 1}, each=("share", (1, 0.68))
    )
    against_backward = Curve("backward", "pitch", (-0.3, 0.5), "On hip flexors, over the lean.", at={"load": 1})

    @staticmethod
    def output(p, u, x, y):
        effort = p.share * p.proportional * (u.pitch - p.reference) + p.derivative * u.pitch_rate
        weight = u.gate * p.load_gain * abs(u.load)
        y.forward = weight * max(0.0, effort)
        y.backward = weight * max(0.0, -effort)
