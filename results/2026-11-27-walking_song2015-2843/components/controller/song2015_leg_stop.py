from gaitsim.component import Component, Curve, Input, Output, Parameter


class Song2015LegStop(Component):
    """Stops the leg at the end of its swing: M9 of Song & Geyer (2015).

    Hamstrings: s = k {l_HAM - l_tgt}+. Short head of the biceps femoris and gastrocnemius, which hold the knee:
    k_B {s - s_0}+ and k_G {s - s_0}+.
    """

    hamstrings_gain = Parameter("1", "k: stimulation per l_opt.", bounds=(-100, 100))
    biceps_gain = Parameter("1", "k_B: stimulation per stimulation of the hamstrings.", bounds=(-100, 100))
    gastrocnemius_gain = Parameter("1", "k_G: stimulation per stimulation of the hamstrings.", bounds=(-100, 100))
    threshold = Parameter("1", "s_0: stimulation of the hamstrings without effect on them.", bounds=(-10, 10))
    length = Input("1", "l_HAM in l_opt.")
    target_length = Input("1", "l_tgt: the one that they have at the target.")
    gate = Input("1", "1 lets the module through, 0 leaves nothing.", default=1)
    hamstrings = Output("1", "Contribution to the excitation of the hamstrings.")
    biceps = Output("1", "Contribution to the excitation of the short head of the biceps femoris.")
    gastrocnemius = Output("1", "Contribution to the excitation of the gastrocnemius.")

    answer = Curve(
        "gastrocnemius",
        "length",
        (0.8, 1.4),
        "Gastrocnemius over the length of the hamstrings.",
        at={"hamstrings_gain": 6, "gastrocnemius_gain": 2, "threshold": 0.65, "target_length": 1},
    )

    @staticmethod
    def output(p, u, x, y):
        stimulation = p.hamstrings_gain * max(0.0, u.length - u.target_length)
        above = max(0.0, stimulation - p.threshold)
        y.hamstrings = u.gate * stimulation
        y.biceps = u.gate * p.biceps_gain * above
        y.gastrocnemius = u.gate * p.gastrocnemius_gain * above
