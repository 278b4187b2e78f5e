from gaitsim.component import Component, Input, Output


class SwingChoice(Component):
    """Selects the leg that swings next in double support: the one further from its target (Song & Geyer 2015).

    The distance of a leg from its target is |a - a_tgt| + |b - b_tgt|, with the angle of the leg
    a = phi_hip - phi_knee / 2 in the sagittal plane, and the abduction b of the hip. Each leg has such a part, which
    reads the distance of the other.
    """

    hip_angle = Input("rad", "phi_hip: 180 deg upright, increases in extension.")
    knee_angle = Input("rad", "phi_knee: 180 deg straight, increases in extension.")
    target = Input("rad", "a_tgt: target angle of the leg.")
    abduction = Input("rad", "b: abduction of the hip.", default=0)
    abduction_target = Input("rad", "b_tgt.", default=0)
    opposite_mismatch = Input("rad", "Distance of the other leg from its target.")
    in_stance = Input("1", "1 while the leg stands.")
    opposite_in_stance = Input("1", "1 while the other leg stands.")
    angle = Output("rad", "a: angle of the leg; 90 deg if it is under an upright trunk, less in front of it.")
    mismatch = Output("rad", "How far the leg is from its target.")
    initiation = Output("1", "I: 1 while both legs stand and this one shall swing.")

    @staticmethod
    def output(p, u, x, y):
        y.angle = u.hip_angle - 0.5 * u.knee_angle
        y.mismatch = abs(y.angle - u.target) + abs(u.abduction - u.abduction_target)
        both = u.in_stance > 0.5 and u.opposite_in_stance > 0.5
        y.initiation = 1.0 if both and y.mismatch > u.opposite_mismatch else 0.0
