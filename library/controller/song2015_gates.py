from gaitsim.component import Component, Input, Output, Parameter


class Song2015Gates(Component):
    """Gates of the modules of a leg in stance, in the transition to swing, and in swing (Song & Geyer 2015).

    A leg in stance supports the body. When it is to swing in double support (I = 1), its support decreases with the
    load L_c on the other leg, to 1 - k_sup L_c, and the swing modules open by k_tr L_c. A support below 0 reduces
    stimulation.
    """

    suppression = Parameter("1", "k_sup: loss of support per body weight on the other leg.", bounds=(0, 1000))
    transition = Parameter("1", "k_tr: opening of swing per body weight on the other leg.", bounds=(0, 100))
    in_stance = Input("1", "1 while the leg stands.")
    initiation = Input("1", "I: 1 in double support if this leg is to swing.")
    opposite_load = Input("1", "L_c: load on the other leg in body weights.")
    support = Output("1", "Gate of the modules that support the body weight: M1 and M2.")
    swing = Output("1", "1 in swing.")
    beginning = Output("1", "I k_tr L_c: how far swing has begun while the leg still stands.")
    swing_and_beginning = Output("1", "Gate of what swings the hip, M6.")

    @staticmethod
    def output(p, u, x, y):
        y.support = u.in_stance * (1 - u.initiation * p.suppression * u.opposite_load)
        y.swing = 1.0 - u.in_stance
        y.beginning = u.initiation * p.transition * u.opposite_load
        y.swing_and_beginning = y.swing + y.beginning
