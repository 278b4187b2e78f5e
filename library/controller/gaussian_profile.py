import math

from gaitsim.component import Component, Curve, Input, Output, Parameter


class GaussianProfile(Component):
    """Feedforward stimulation: a Gaussian over the phase of a cycle, S = h exp(-(d / w)^2 / 2), gated.

    d is the shorter distance of the phase from the center around the cycle. Several profiles on one muscle add up.
    """

    height = Parameter("1", "h: stimulation at the center.", bounds=(-1, 1))
    center = Parameter("1", "Phase of the center.", bounds=(0, 1))
    width = Parameter("1", "w: standard deviation, as a share of the cycle.", bounds=(1e-3, 1))
    phase = Input("1", "Phase of the cycle, from 0 to 1.")
    gate = Input("1", "1 enables the stimulation; 0 disables it.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    bell = Curve(
        "stimulation",
        "phase",
        (0, 1),
        "Stimulation over the phase; the profile wraps around the cycle.",
        at={"height": 0.5, "width": 0.1},
        each=("center", (0.5, 0.9)),
    )

    @staticmethod
    def output(p, u, x, y):
        distance = ((u.phase - p.center + 0.5) % 1 - 0.5) / p.width
        y.stimulation = u.gate * p.height * math.exp(-0.5 * distance * distance)
