from gaitsim.component import Component, Input, Output


class MotorNeurons(Component):
    """The sum of all stimulations of one muscle; the muscle clips it."""

    stimulations = Input("1", "Contributions of reflexes; excitation is positive, inhibition negative.", sums=True)
    excitation = Output("1", "Their sum.")

    @staticmethod
    def output(p, u, x, y):
        y.excitation = u.stimulations
