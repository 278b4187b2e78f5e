import math

from gaitsim.component import Component, Curve, Input, Output, Parameter


class GaussianProfile(Component):
    """Stimulation without feedback: a bell over the phase of a cycle, S = h exp(-(d / w)^2 / 2), gated.

    d is the distance of the phase from the center, the shorter way round. Several bells on one muscle add up.
    """

    height = Parameter("1", "h: stimulation at the center.", bounds=(-1, 1))
    center = Parameter("1", "Phase of the center.", bounds=(0, 1))
    width = Parameter("1", "w: standard deviation of the bell, in phase.", bounds=(1e-3, 1))
    phase = Input("1", "Phase of the cycle, from 0 to 1.")
    gate = Input("1", "1 lets the stimulation through, 0 leaves nothing.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    bell = Curve(
        "stimulation",
        "phase",
        (0, 1),
        "Stimulation over the phase; the bell reaches round the cycle.",
        at={"height": 0.5, "width": 0.1},
        each=("center", (0.5, 0.9)),
    )

    @staticmethod
    def output(p, u, x, y):
        distance = ((u.phase - p.center + 0.5) % 1 - 0.5) / p.width
        y.stimulation = u.gate * p.height * math.exp(-0.5 * distance * distance)
