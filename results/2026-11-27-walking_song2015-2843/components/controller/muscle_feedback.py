from gaitsim.component import Component, Curve, Input, Output, Parameter


class MuscleFeedback(Component):
    """Stimulation from one delayed muscle signal: STIM = STIM_0 + G (P - P_0), gated.

    With the normalized force, length or velocity as P this is the force, length or velocity
    feedback of Geyer et al. (2003).
    """

    gain = Parameter("1", "Gain G per unit of the normalized signal.", bounds=(-100, 100))
    offset = Parameter(
        "1",
        "P_0: signal at which the feedback adds nothing.",
        default=0,
        bounds=(-10, 10),
        source="geyer2003, force feedback",
    )
    bias = Parameter("1", "STIM_0: stimulation without feedback.", default=0.01, bounds=(0, 1), source="geyer2003")
    signal = Input("1", "Normalized force, fiber length or fiber velocity.")
    gate = Input("1", "1 enables the feedback; at 0 only the bias remains.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    answer = Curve(
        "stimulation", "signal", (0, 1.5), "Stimulation over the signal, G = 3.", at={"gain": 3}, each=("gate", (1, 0))
    )

    @staticmethod
    def output(p, u, x, y):
        y.stimulation = p.bias + u.gate * p.gain * (u.signal - p.offset)
