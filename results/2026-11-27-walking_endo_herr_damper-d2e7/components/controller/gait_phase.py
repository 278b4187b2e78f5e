from gaitsim.component import Component, Curve, Input, Output, Parameter, State


def begins(before, now):
    """1 in the instant after a condition becomes true, else 0."""
    return 1.0 if now and not before else 0.0


class GaitPhase(Component):
    """Phase of a leg: swing, stance, or trailing leg in double support.

    swing -> stance when the load on the leg exceeds the threshold; stance -> trailing when the other leg lands
    later; trailing -> stance if the other leg lifts off again; any -> swing when the load on the leg
    ends. Trailing is the double support (DSup) of Geyer & Herr (2010). If both legs land in the
    same step, neither trails. The phase is known one step after the loads that determine it. A leg that starts
    in stance (`initial: {<address>.phase: 1}`) stands until it has been loaded and unloaded.
    """

    threshold = Parameter(
        "1", "Load above which a leg stands, in body weights.", default=0.1, bounds=(0, 1), source="geijtenbeek2019"
    )
    load = Input("1", "Load on this leg in body weights.")
    opposite_load = Input("1", "Load on the other leg in body weights.", default=0)
    phase = State(levels=("swing", "stance", "trailing"), doc="Phase of the leg.")
    loaded = State("1", "1 while the leg's own load is above the threshold.")
    opposite_stands = State("1", "1 while the other leg stands.")
    lifted = State("1", "1 in the instant after take-off.")
    landed = State("1", "1 in the instant after touchdown.")
    in_stance = Output("1", "1 in stance, double support included; gates other parts.")
    in_swing = Output("1", "1 in swing.")
    in_double_support = Output("1", "DSup: 1 while both legs stand and the other landed last.")
    takeoff = Output("1", "1 for one step at take-off.")
    touchdown = Output("1", "1 for one step at touchdown.")

    standing = Curve(
        "in_stance",
        "time",
        (0, 1),
        "Stance, from the loads on both legs.",
        steps={"load": (0, 1, 1, 1, 0), "opposite_load": (1, 1, 0, 1, 1)},
    )
    trailing = Curve(
        "in_double_support",
        "time",
        (0, 1),
        "Double support, from the loads on both legs.",
        steps={"load": (0, 1, 1, 1, 0), "opposite_load": (1, 1, 0, 1, 1)},
    )

    @staticmethod
    def start(p, u, x):
        x.loaded = 1.0 if u.load > p.threshold else 0.0
        x.phase = 1 if x.loaded > 0.5 else 0
        x.opposite_stands = 1.0 if u.opposite_load > p.threshold else 0.0
        x.lifted = 0.0
        x.landed = 0.0

    @staticmethod
    def output(p, u, x, y):
        y.in_swing = 1.0 if x.phase < 0.5 else 0.0
        y.in_stance = 1.0 - y.in_swing
        y.in_double_support = 1.0 if x.phase > 1.5 else 0.0
        y.takeoff = x.lifted
        y.touchdown = x.landed

    @staticmethod
    def update(p, u, x, y, dt):
        loaded = u.load > p.threshold
        stood = x.phase > 0.5
        stands = loaded or (stood and x.loaded < 0.5)
        opposite_stood, opposite_stands = x.opposite_stands > 0.5, u.opposite_load > p.threshold
        if not stands:
            x.phase = 0
        elif not (stood and opposite_stands):
            x.phase = 1
        elif not opposite_stood:
            x.phase = 2
        x.lifted = begins(not stood, not stands)
        x.landed = begins(stood, stands)
        x.loaded = 1.0 if loaded else 0.0
        x.opposite_stands = 1.0 if opposite_stands else 0.0
