from gaitsim.component import Component, Curve, Input, Output, Parameter


def felt(signal, offset, floor):
    """Signal minus offset, with a lower bound."""
    return max(floor, signal - offset)


class MuscleReflex(Component):
    """Stimulation from a muscle's delayed length, force and velocity, as in SCONE's MuscleReflex.

    S = S_0 + K_L (l - l_0) + K_F (F - F_0) + K_V (v - v_0), gated. Each difference has a lower bound, its floor. By
    default, short fibers and low forces reduce the stimulation (a floor out of reach), and shortening does not (a
    floor of 0); these are SCONE's allow_neg_L, allow_neg_F and allow_neg_V. SCONE has velocities in l_opt/s: its K_V
    is the one here divided by v_max.
    """

    length_gain = Parameter(
        "1", "K_L: stimulation per l_opt.", default=0, bounds=(-100, 100), source="geijtenbeek2019: no such reflex"
    )
    length_offset = Parameter(
        "1",
        "l_0: length at which the reflex adds nothing, in l_opt.",
        default=1,
        bounds=(-10, 10),
        source="geijtenbeek2019",
    )
    length_floor = Parameter(
        "1",
        "Lower bound of l - l_0; 0 if a fiber shorter than l_0 shall have no effect.",
        default=-1e6,
        bounds=(-1e6, 0),
        source="geijtenbeek2019",
    )
    force_gain = Parameter(
        "1", "K_F: stimulation per F_max.", default=0, bounds=(-100, 100), source="geijtenbeek2019: no such reflex"
    )
    force_offset = Parameter(
        "1",
        "F_0: force at which the reflex adds nothing, in F_max.",
        default=0,
        bounds=(-10, 10),
        source="geijtenbeek2019",
    )
    force_floor = Parameter(
        "1",
        "Lower bound of F - F_0; 0 if a force below F_0 shall have no effect.",
        default=-1e6,
        bounds=(-1e6, 0),
        source="geijtenbeek2019",
    )
    velocity_gain = Parameter(
        "1", "K_V: stimulation per v_max.", default=0, bounds=(-100, 100), source="geijtenbeek2019: no such reflex"
    )
    velocity_offset = Parameter(
        "1",
        "v_0: velocity at which the reflex adds nothing, in v_max.",
        default=0,
        bounds=(-10, 10),
        source="geijtenbeek2019",
    )
    velocity_floor = Parameter(
        "1",
        "Lower bound of v - v_0; -1e6 if shortening shall reduce the stimulation.",
        default=0,
        bounds=(-1e6, 0),
        source="geijtenbeek2019",
    )
    bias = Parameter(
        "1", "S_0: stimulation without feedback.", default=0, bounds=(-1, 1), source="geijtenbeek2019: none"
    )
    length = Input("1", "Normalized fiber length, in l_opt.", default=0)
    force = Input("1", "Normalized force, in F_max.", default=0)
    velocity = Input("1", "Normalized fiber velocity, in v_max; shortening is negative.", default=0)
    gate = Input("1", "1 enables the reflex; 0 disables it, including S_0.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    by_length = Curve(
        "stimulation",
        "length",
        (0.4, 1.6),
        "Stimulation over the length.",
        at={"length_gain": 0.65, "length_offset": 0.54},
    )
    by_velocity = Curve(
        "stimulation",
        "velocity",
        (-1, 1),
        "Stimulation over the velocity; with and without an effect of shortening.",
        at={"velocity_gain": 1},
        each=("velocity_floor", (0, -1e6)),
    )

    @staticmethod
    def output(p, u, x, y):
        by_length = p.length_gain * felt(u.length, p.length_offset, p.length_floor)
        by_force = p.force_gain * felt(u.force, p.force_offset, p.force_floor)
        by_velocity = p.velocity_gain * felt(u.velocity, p.velocity_offset, p.velocity_floor)
        y.stimulation = u.gate * (p.bias + by_length + by_force + by_velocity)
