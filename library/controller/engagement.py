from gaitsim.component import Component, Curve, Input, Output, Parameter, State


class Engagement(Component):
    """Engages a clutch at a phase of each cycle, and releases it once its spring has returned its energy.

    Endo et al. (2006) fitted the instants of engagement to a recorded walk.
    """

    engages = Parameter("1", "Phase at which the clutch is engaged.", bounds=(0, 1))
    phase = Input("1", "Phase of the cycle, from 0 to 1.")
    stretch = Input("m", "Stretch of the clutch's spring.")

    before = State("1", "Phase one step ago.")
    engaged = State(levels=("no", "yes"), doc="Whether the clutch is engaged.")
    stretched = State(levels=("no", "yes"), doc="Whether its spring has been stretched since the clutch engaged.")

    gate = Output("1", "1 while the clutch is engaged.")

    engaged_curve = Curve(
        "gate",
        "time",
        (0, 1),
        "The gate: engaged at 30 % of the cycle, stretched and released.",
        at={"engages": 0.3},
        steps={"phase": (0, 0.2, 0.4, 0.6, 0.8), "stretch": (0, 0, 0.01, 0.01, 0)},
    )

    @staticmethod
    def start(p, u, x):
        x.before = u.phase
        x.engaged = 0
        x.stretched = 0

    @staticmethod
    def output(p, u, x, y):
        y.gate = 1.0 if x.engaged > 0.5 else 0.0

    @staticmethod
    def update(p, u, x, y, dt):
        if u.stretch > 0:
            x.stretched = 1
        elif x.stretched > 0.5:
            x.engaged = 0
        passed, gone = (u.phase - p.engages) % 1, (u.phase - x.before) % 1
        if passed < gone:
            x.engaged = 1
            x.stretched = 0
        x.before = u.phase
