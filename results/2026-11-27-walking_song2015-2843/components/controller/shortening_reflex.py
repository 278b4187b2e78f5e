from gaitsim.component import Component, Curve, Input, Output, Parameter


class ShorteningReflex(Component):
    """Stimulation by the shortening of another muscle: S = -k {v}-, gated.

    M7 of Song & Geyer (2015): the rectus femoris shortens as the hip flexes, and has the short head of the biceps
    flex the knee.
    """

    gain = Parameter("s", "k: stimulation per l_opt/s of shortening.", bounds=(-100, 100))
    max_contraction_velocity = Parameter(
        "1/s", "v_max of the muscle that is felt, in l_opt/s.", default=12, bounds=(1, 50), source="songmodel"
    )
    velocity = Input("1", "Its fiber velocity in v_max; shortening is negative.")
    gate = Input("1", "1 lets the reflex through, 0 leaves nothing.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    answer = Curve("stimulation", "velocity", (-0.5, 0.5), "Over the velocity, k = 1.25 s.", at={"gain": 1.25})

    @staticmethod
    def output(p, u, x, y):
        y.stimulation = -u.gate * p.gain * p.max_contraction_velocity * min(0.0, u.velocity)
