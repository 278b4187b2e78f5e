from gaitsim.component import Component, Curve, Input, Output, Parameter

from ._reflex import gated


class ClippedSum(Component):
    """A sum of stimulations that is clipped before further terms are added: S = clip(S_1 + S_2 + ...), gated.

    In the running model of Wang et al. (2012), swing initiation is subtracted from the clipped stimulation of vasti
    and glutei and added to that of the hip flexors. It thus has its full effect even where the reflexes saturate.
    """

    lower = Parameter("1", "Minimum stimulation.", default=0.01, bounds=(0, 1), source="geyer2010")
    upper = Parameter("1", "Maximum stimulation.", default=1, bounds=(0, 1), source="geyer2010")
    stimulations = Input("1", "Stimulations that are summed.", sums=True)
    gate = Input("1", "1 enables the sum; 0 disables it.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    clipped = Curve("stimulation", "stimulations", (-0.5, 1.5), "The clipped sum over the sum.")

    @staticmethod
    def output(p, u, x, y):
        y.stimulation = gated(u.stimulations, u.gate, p.lower, p.upper)
