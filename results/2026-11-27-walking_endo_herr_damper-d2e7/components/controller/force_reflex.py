from gaitsim.component import Component, Curve, Input, Output, Parameter

from ._reflex import LOWER, UPPER, gated


class ForceReflex(Component):
    """Stimulation from a muscle's delayed force: S = S_0 + G (F - F_off), clamped and gated.

    With G > 0 on a muscle's own force this is the positive force feedback of Geyer & Herr (2010):
    S_SOL = S_0 + G_SOL F_SOL(t - 20 ms) in stance.
    """

    gain = Parameter("1", "G: stimulation per F_max; negative inhibits.", bounds=(-10, 10))
    offset = Parameter(
        "1", "F_off: force at which the reflex adds nothing, in F_max.", default=0, bounds=(-10, 10), source="geyer2010"
    )
    bias = Parameter("1", "S_0: stimulation at F_off.", default=0.01, bounds=(-1, 1), source="geyer2010")
    lower = LOWER
    upper = UPPER
    signal = Input("1", "Normalized force of a muscle, in F_max.")
    gate = Input("1", "1 enables the reflex; 0 disables it, including S_0.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    answer = Curve("stimulation", "signal", (0, 1.5), "Stimulation over the force, G = 1.2.", at={"gain": 1.2})

    @staticmethod
    def output(p, u, x, y):
        wanted = p.bias + p.gain * (u.signal - p.offset)
        y.stimulation = gated(wanted, u.gate, p.lower, p.upper)
