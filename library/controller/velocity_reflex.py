from gaitsim.component import Component, Curve, Input, Output, Parameter

from ._reflex import LOWER, UPPER, gated


class VelocityReflex(Component):
    """Stimulation from a muscle's delayed fiber velocity: S = S_0 + G (v - v_off), clamped and gated.

    A stretch reflex has G > 0 and lower = 0: only lengthening excites. A gain per l_opt/s becomes
    one per v_max when multiplied by v_max in l_opt/s.
    """

    gain = Parameter("1", "G: stimulation per v_max; negative inhibits.", bounds=(-100, 100))
    offset = Parameter(
        "1",
        "v_off: velocity at which the reflex adds nothing, in v_max.",
        default=0,
        bounds=(-10, 10),
        source="definition: a fiber at rest",
    )
    bias = Parameter(
        "1",
        "S_0: stimulation at v_off.",
        default=0,
        bounds=(-1, 1),
        source="definition: usually added to another reflex that has S_0",
    )
    lower = LOWER
    upper = UPPER
    signal = Input("1", "Normalized fiber velocity of a muscle, in v_max; shortening is negative.")
    gate = Input("1", "1 enables the reflex; 0 disables it, including S_0.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    answer = Curve(
        "stimulation", "signal", (-1, 1), "A stretch reflex: lengthening excites.", at={"gain": 1, "lower": 0}
    )

    @staticmethod
    def output(p, u, x, y):
        wanted = p.bias + p.gain * (u.signal - p.offset)
        y.stimulation = gated(wanted, u.gate, p.lower, p.upper)
