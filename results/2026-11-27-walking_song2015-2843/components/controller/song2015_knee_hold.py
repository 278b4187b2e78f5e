from gaitsim.component import Component, Input, Output, Parameter


class Song2015KneeHold(Component):
    """Holds the flexed knee while the leg swings forwards: M8 of Song & Geyer (2015).

    Rectus femoris: k_RF {v_VAS}+, against flexion. Short head of the biceps femoris: against extension,
    k {v_BFSH}+ {v_BFSH / p + v_RF / a}+ {(l_RF - l_tgt) / a}+, by which the knee may
    extend as fast as the leg comes to its target. Velocities are in l_opt/s.
    """

    rectus_gain = Parameter("s", "k_RF: stimulation per l_opt/s.", bounds=(-100, 100))
    biceps_gain = Parameter("s^2", "k: stimulation per l_opt/s, rad/s and rad.", bounds=(-1000, 1000))
    biceps_slope = Parameter("1/rad", "p: fiber length of the biceps over the angle of the knee.", bounds=(0.01, 10))
    rectus_slope = Parameter("1/rad", "a: fiber length of the rectus over the angle of the leg.", bounds=(0.01, 10))
    max_contraction_velocity = Parameter(
        "1/s", "v_max of the three muscles, in l_opt/s.", default=12, bounds=(1, 50), source="songmodel"
    )
    vastus_velocity = Input("1", "v_VAS: fiber velocity in v_max; lengthening is positive.")
    biceps_velocity = Input("1", "v_BFSH: fiber velocity in v_max.")
    rectus_velocity = Input("1", "v_RF: fiber velocity in v_max.")
    rectus_length = Input("1", "l_RF in l_opt.")
    rectus_target = Input("1", "l_tgt: the one that it has at the target.")
    gate = Input("1", "1 lets the module through, 0 leaves nothing.", default=1)
    rectus = Output("1", "Contribution to the excitation of the rectus femoris.")
    biceps = Output("1", "Contribution to the excitation of the short head of the biceps femoris.")

    @staticmethod
    def output(p, u, x, y):
        knee = p.max_contraction_velocity * u.biceps_velocity
        turn = knee / p.biceps_slope + p.max_contraction_velocity * u.rectus_velocity / p.rectus_slope
        left = (u.rectus_length - u.rectus_target) / p.rectus_slope
        y.rectus = u.gate * p.rectus_gain * p.max_contraction_velocity * max(0.0, u.vastus_velocity)
        y.biceps = u.gate * p.biceps_gain * max(0.0, knee) * max(0.0, turn) * max(0.0, left)
