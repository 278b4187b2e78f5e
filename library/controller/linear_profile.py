from gaitsim.component import Component, Curve, Input, Output, Parameter


def hat(phase, corner):
    """Weight of one of eight values: 1 at its phase, linearly to 0 at its neighbours, around the cycle."""
    return max(0.0, 1 - 8 * abs((phase - corner / 8 + 0.5) % 1 - 0.5))


class LinearProfile(Component):
    """Feedforward stimulation: linear interpolation of eight values over the phase of a cycle, gated."""

    value_0 = Parameter("1", "Stimulation at phase 0, and at 1.", bounds=(-1, 1))
    value_1 = Parameter("1", "Stimulation at phase 1/8.", bounds=(-1, 1))
    value_2 = Parameter("1", "Stimulation at phase 2/8.", bounds=(-1, 1))
    value_3 = Parameter("1", "Stimulation at phase 3/8.", bounds=(-1, 1))
    value_4 = Parameter("1", "Stimulation at phase 4/8.", bounds=(-1, 1))
    value_5 = Parameter("1", "Stimulation at phase 5/8.", bounds=(-1, 1))
    value_6 = Parameter("1", "Stimulation at phase 6/8.", bounds=(-1, 1))
    value_7 = Parameter("1", "Stimulation at phase 7/8.", bounds=(-1, 1))
    phase = Input("1", "Phase of the cycle, from 0 to 1.")
    gate = Input("1", "1 enables the stimulation; 0 disables it.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    lines = Curve(
        "stimulation",
        "phase",
        (0, 1),
        "Stimulation over the phase.",
        at={
            "value_0": 0.1,
            "value_1": 0.2,
            "value_2": 0.6,
            "value_3": 0.4,
            "value_4": 0,
            "value_5": 0,
            "value_6": -0.1,
            "value_7": 0,
        },
    )

    @staticmethod
    def output(p, u, x, y):
        first = p.value_0 * hat(u.phase, 0) + p.value_1 * hat(u.phase, 1)
        second = p.value_2 * hat(u.phase, 2) + p.value_3 * hat(u.phase, 3)
        third = p.value_4 * hat(u.phase, 4) + p.value_5 * hat(u.phase, 5)
        fourth = p.value_6 * hat(u.phase, 6) + p.value_7 * hat(u.phase, 7)
        y.stimulation = u.gate * (first + second + third + fourth)
