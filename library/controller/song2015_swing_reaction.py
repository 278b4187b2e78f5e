from gaitsim.component import Component, Input, Output, Parameter


class Song2015SwingReaction(Component):
    """Compensates the reaction of the trunk to the other leg's swing: M4 of Song & Geyer (2015).

    Hip flexors: k_1 S_c,GLU + k_2 S_c,HAM. Glutei: k_3 S_c,HFL + k_4 S_c,RF. Hamstrings: k_GH times the glutei's. S_c
    are stimulations of the other leg's modules of swing, M6 and M10 of hip flexors and glutei, M8 of the rectus femoris
    and M9 of the hamstrings. Open while the other leg swings.
    """

    gluteus_hip_flexor = Parameter("1", "k_1.", bounds=(-100, 100))
    hamstrings_hip_flexor = Parameter("1", "k_2.", bounds=(-100, 100))
    hip_flexor_gluteus = Parameter("1", "k_3.", bounds=(-100, 100))
    rectus_gluteus = Parameter("1", "k_4.", bounds=(-100, 100))
    hamstrings_share = Parameter("1", "k_GH.", bounds=(-100, 100))
    opposite_hip_flexor = Input("1", "S_c,HFL.")
    opposite_gluteus = Input("1", "S_c,GLU.")
    opposite_rectus = Input("1", "S_c,RF.")
    opposite_hamstrings = Input("1", "S_c,HAM.")
    opposite_in_stance = Input("1", "1 while the other leg stands.")
    hip_flexor = Output("1", "Contribution to the excitation of the hip flexors.")
    gluteus = Output("1", "Contribution to the excitation of the glutei.")
    hamstrings = Output("1", "Contribution to the excitation of the hamstrings.")

    @staticmethod
    def output(p, u, x, y):
        swings = 1 - u.opposite_in_stance
        y.hip_flexor = swings * (
            p.gluteus_hip_flexor * u.opposite_gluteus + p.hamstrings_hip_flexor * u.opposite_hamstrings
        )
        y.gluteus = swings * (p.hip_flexor_gluteus * u.opposite_hip_flexor + p.rectus_gluteus * u.opposite_rectus)
        y.hamstrings = p.hamstrings_share * y.gluteus
