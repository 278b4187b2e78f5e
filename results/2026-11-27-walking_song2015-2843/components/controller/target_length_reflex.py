from gaitsim.component import Component, Curve, Input, Output, Parameter


class TargetLengthReflex(Component):
    """Moves a joint to a target angle by a muscle's length: S = k {l - l_tgt}+ + k_v {v}-, gated (Song & Geyer 2015).

    l_tgt = 1 + c (a_tgt + b - a_ref) is the length that the muscle has at the target: M6, M9 and M10 of the paper, of
    which M6 also has the velocity. {}+ is the positive part, {}- the negative one: shortening brakes.
    """

    gain = Parameter("1", "k: stimulation per l_opt.", bounds=(-100, 100))
    velocity_gain = Parameter(
        "s", "k_v: stimulation per l_opt/s of shortening.", default=0, bounds=(-100, 100), source="songmodel: M10"
    )
    slope = Parameter("1/rad", "c: fiber length over the angle, in l_opt.", bounds=(-10, 10))
    reference = Parameter("deg", "a_ref: angle at which the fiber is l_opt.", bounds=(-360, 360))
    offset = Parameter("deg", "b: angle added to the target.", default=0, bounds=(-360, 360), source="songmodel: M6")
    max_contraction_velocity = Parameter(
        "1/s", "v_max of the muscle, in l_opt/s.", default=12, bounds=(1, 50), source="songmodel"
    )
    length = Input("1", "Fiber length of the muscle that is felt, in l_opt.")
    velocity = Input("1", "Its fiber velocity in v_max; shortening is negative.", default=0)
    target = Input("rad", "a_tgt: target angle.")
    gate = Input("1", "1 lets the reflex through, 0 leaves nothing.", default=1)
    target_length = Output("1", "l_tgt in l_opt.")
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    approach = Curve(
        "stimulation",
        "length",
        (0.6, 1.4),
        "Over the length of the rectus femoris, for targets of 60, 70 and 80 deg.",
        at={"gain": 0.85, "slope": 0.24, "reference": 135.5},
        each=("target", (1.047, 1.222, 1.396)),
    )

    @staticmethod
    def output(p, u, x, y):
        y.target_length = 1 + p.slope * (u.target + p.offset - p.reference)
        shortening = min(0.0, u.velocity) * p.max_contraction_velocity
        y.stimulation = u.gate * (p.gain * max(0.0, u.length - y.target_length) + p.velocity_gain * shortening)
