from gaitsim.component import Component, Input, Output, Parameter


class RunningGates(Component):
    """Gates of the control laws of a running leg, from its phases (Wang et al. 2012).

    d is the distance of the foot behind the body's center of mass in leg lengths; in front it is negative. Stance
    has two further laws: the trunk's balance until the other leg has landed in front, and the initiation of swing once
    d > d_si or, if the other leg has landed, once d > 0. Swing has an early part, and the preparation of stance once
    d < d_sp. The conditions are those of a public re-implementation (mharding01/
    augmented-neuromuscular-RT-running, MIT).
    """

    leg_length = Parameter("m", "Length of the leg, the unit of d.", bounds=(0.01, 10))
    initiation_distance = Parameter("1", "d_si: distance beyond which swing is initiated.", bounds=(-2, 2))
    preparation_distance = Parameter(
        "1", "d_sp: distance below which the leg in swing prepares stance.", bounds=(-2, 2)
    )
    center = Input("m", "Forward position of the body's center of mass.")
    foot = Input("m", "Forward position of the foot.")
    in_stance = Input("1", "1 while the leg stands.")
    in_double_support = Input("1", "1 while both legs stand and the other landed last.")
    distance = Output("1", "d: distance of the foot behind the center of mass, in leg lengths.")
    stance = Output("1", "1 while the leg stands.")
    balance = Output("1", "1 in stance until the other leg has landed.")
    trailing = Output("1", "1 in stance once the other leg has landed.")
    initiation = Output("1", "1 in stance during swing initiation.")
    swing = Output("1", "1 in swing.")
    early_swing = Output("1", "1 in swing until the preparation.")
    preparation = Output("1", "1 in swing during preparation of stance.")

    @staticmethod
    def output(p, u, x, y):
        y.distance = (u.center - u.foot) / p.leg_length
        y.stance = 1.0 if u.in_stance > 0.5 else 0.0
        y.trailing = 1.0 if y.stance > 0.5 and u.in_double_support > 0.5 else 0.0
        y.balance = y.stance - y.trailing
        behind = y.distance > p.initiation_distance or (y.trailing > 0.5 and y.distance > 0)
        y.initiation = 1.0 if y.stance > 0.5 and behind else 0.0
        y.swing = 1.0 - y.stance
        y.preparation = 1.0 if y.swing > 0.5 and y.distance < p.preparation_distance else 0.0
        y.early_swing = y.swing - y.preparation
