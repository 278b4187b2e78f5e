from gaitsim.component import Component, Curve, Input, Output, Parameter, State

EARLY_STANCE, LATE_STANCE, LIFTOFF, SWING, LANDING = 0, 1, 2, 3, 4


def first_phase(stands, behind, past, ahead):
    """The phase of a leg at the start, from its position and load alone."""
    if stands:
        return LIFTOFF if behind else (LATE_STANCE if past else EARLY_STANCE)
    return LANDING if ahead else SWING


def stance_phase(phase, behind, past, far_behind):
    """The next phase of a leg in early or late stance."""
    if behind or (phase == LATE_STANCE and far_behind):
        return LIFTOFF
    return LATE_STANCE if past else phase


def air_phase(phase, stands, leads, ahead):
    """The next phase of a leg in swing or before its landing."""
    if stands and (leads or phase == LANDING):
        return EARLY_STANCE
    return LANDING if ahead and not stands else phase


class SconePhases(Component):
    """The five phases of a leg in SCONE: early and late stance, lift-off, swing, landing.

    They follow from the loads on both legs and from the positions of the feet in front of the hip. Early stance
    becomes late stance once the foot is behind a place. Both become lift-off once the other foot stands in front; late
    stance also does once the own foot is far behind. Lift-off becomes swing when the load is gone, and swing becomes
    landing once the foot is in front of a place. Landing becomes early stance when the foot bears load. A foot in swing
    that bears load in front of the other is in early stance too; one that scuffs behind it stays in swing. The phase is
    known one step after the signals that determine it.
    """

    stance_load = Parameter(
        "1", "Load above which a leg stands, in body weights.", default=0.1, bounds=(0, 1), source="geijtenbeek2019"
    )
    swing_load = Parameter(
        "1", "Load at which lift-off ends, in body weights.", default=0.1, bounds=(0, 1), source="geijtenbeek2019"
    )
    late_stance_position = Parameter(
        "m",
        "Late stance begins when the foot is behind this position.",
        default=0,
        bounds=(-1, 1),
        source="geijtenbeek2019",
    )
    liftoff_position = Parameter(
        "m",
        "Late stance becomes lift-off when the foot is behind this position.",
        default=-1,
        bounds=(-2, 1),
        source="geijtenbeek2019: out of reach",
    )
    landing_position = Parameter(
        "m",
        "Landing begins when the foot is in front of this position.",
        default=0,
        bounds=(-1, 1),
        source="geijtenbeek2019",
    )
    load = Input("1", "Load on this leg in body weights.")
    opposite_load = Input("1", "Load on the other leg in body weights.")
    position = Input("m", "Position of the foot in front of the hip.")
    opposite_position = Input("m", "Position of the other foot in front of the hip.")
    phase = State(levels=("early_stance", "late_stance", "liftoff", "swing", "landing"), doc="Phase of the leg.")
    lifted = State("1", "1 in the instant after lift-off has ended.")
    landed = State("1", "1 in the instant after landing has ended.")
    early_stance = Output("1", "1 in early stance; this and the following outputs gate other parts.")
    late_stance = Output("1", "1 in late stance.")
    liftoff = Output("1", "1 in lift-off.")
    swing = Output("1", "1 in swing.")
    landing = Output("1", "1 before landing.")
    stance_before_liftoff = Output("1", "1 in early and late stance.")
    in_stance = Output("1", "1 in early stance, late stance and lift-off.")
    in_swing = Output("1", "1 in swing and before landing.")
    takeoff = Output("1", "1 for one step when swing begins.")
    touchdown = Output("1", "1 for one step when early stance begins.")

    standing = Curve(
        "in_stance",
        "time",
        (0, 1),
        "Stance, from load and position of the foot.",
        steps={"load": (1, 1, 1, 0, 0), "position": (0.3, -0.1, -0.3, -0.1, 0.3), "opposite_load": (0, 0, 1, 1, 1)},
    )
    lifting = Curve(
        "liftoff",
        "time",
        (0, 1),
        "Lift-off, once the other foot stands in front.",
        steps={"load": (1, 1, 1, 0, 0), "position": (0.3, -0.1, -0.3, -0.1, 0.3), "opposite_load": (0, 0, 1, 1, 1)},
    )

    @staticmethod
    def start(p, u, x):
        behind = u.opposite_load > p.stance_load and u.position < u.opposite_position
        past, ahead = u.position < p.late_stance_position, u.position > p.landing_position
        x.phase = first_phase(u.load > p.stance_load, behind, past, ahead)
        x.lifted = 0.0
        x.landed = 0.0

    @staticmethod
    def output(p, u, x, y):
        y.early_stance = 1.0 if x.phase == EARLY_STANCE else 0.0
        y.late_stance = 1.0 if x.phase == LATE_STANCE else 0.0
        y.liftoff = 1.0 if x.phase == LIFTOFF else 0.0
        y.swing = 1.0 if x.phase == SWING else 0.0
        y.landing = 1.0 if x.phase == LANDING else 0.0
        y.stance_before_liftoff = y.early_stance + y.late_stance
        y.in_stance = y.stance_before_liftoff + y.liftoff
        y.in_swing = y.swing + y.landing
        y.takeoff = x.lifted
        y.touchdown = x.landed

    @staticmethod
    def update(p, u, x, y, dt):
        stands, before = u.load > p.stance_load, x.phase
        behind = u.opposite_load > p.stance_load and u.position < u.opposite_position
        past, far_behind = u.position < p.late_stance_position, u.position < p.liftoff_position
        leads, ahead = u.position > u.opposite_position, u.position > p.landing_position
        if before <= LATE_STANCE:
            x.phase = stance_phase(before, behind, past, far_behind)
        elif before == LIFTOFF:
            x.phase = SWING if u.load <= p.swing_load else LIFTOFF
        else:
            x.phase = air_phase(before, stands, leads, ahead)
        x.lifted = 1.0 if before == LIFTOFF and x.phase == SWING else 0.0
        x.landed = 1.0 if before >= SWING and x.phase == EARLY_STANCE else 0.0
