from gaitsim.component import Component, Curve, Input, Output, Parameter

from ._reflex import gated


class ClippedSum(Component):
    """A sum of stimulations, clipped before more is added or taken away: S = clip(S_1 + S_2 + ...), gated.

    In the running of Wang et al. (2012) what initiates the swing is taken from the clipped stimulation of vasti and
    glutei and added to that of the hip flexors, so that it has its full effect however large their reflexes are.
    """

    lower = Parameter("1", "Least stimulation.", default=0.01, bounds=(0, 1), source="geyer2010")
    upper = Parameter("1", "Largest stimulation.", default=1, bounds=(0, 1), source="geyer2010")
    stimulations = Input("1", "What is summed.", sums=True)
    gate = Input("1", "1 lets the sum through, 0 leaves nothing.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    clipped = Curve("stimulation", "stimulations", (-0.5, 1.5), "The clipped sum over the sum.")

    @staticmethod
    def output(p, u, x, y):
        y.stimulation = gated(u.stimulations, u.gate, p.lower, p.upper)
