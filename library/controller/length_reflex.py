from gaitsim.component import Component, Curve, Input, Output, Parameter

from ._reflex import LOWER, UPPER, gated


class LengthReflex(Component):
    """Stimulation from a muscle's delayed fiber length: S = S_0 + G (l - l_off), clamped and gated.

    The tibialis anterior of Geyer & Herr (2010): S_TA = S_0 + G_TA (l_TA(t - 20 ms) - l_off,TA).
    The paper's table shows no clamp; in its author's release of 2006 the stretch l - l_off is never below 0,
    which is `least: 0`. Without it a fiber shorter than l_off reduces the stimulation.
    """

    gain = Parameter("1", "G: stimulation per l_opt; negative inhibits.", bounds=(-10, 10))
    offset = Parameter("1", "l_off: length at which the reflex adds nothing, in l_opt.", bounds=(-10, 10))
    bias = Parameter("1", "S_0: stimulation at l_off.", default=0.01, bounds=(-1, 1), source="geyer2010")
    least = Parameter(
        "1",
        "Lower bound of G (l - l_off); with 0 and a positive G, a fiber shorter than l_off has no effect.",
        default=-1e6,
        bounds=(-1e6, 0),
        source="definition: a fiber shorter than l_off inhibits",
    )
    lower = LOWER
    upper = UPPER
    signal = Input("1", "Normalized fiber length of a muscle, in l_opt.")
    gate = Input("1", "1 enables the reflex; 0 disables it, including S_0.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    answer = Curve(
        "stimulation", "signal", (0.4, 1.6), "The tibialis anterior of the paper.", at={"gain": 1.1, "offset": 0.71}
    )

    @staticmethod
    def output(p, u, x, y):
        wanted = p.bias + max(p.least, p.gain * (u.signal - p.offset))
        y.stimulation = gated(wanted, u.gate, p.lower, p.upper)
