from gaitsim.component import Component, Input, Output, Parameter


class Prestimulation(Component):
    """A constant stimulation while its gate is open.

    In Geyer & Herr (2010): S_0,BAL of the hip muscles in stance, and dS in double support, which is added to
    the hip flexors and subtracted from the glutei (a negative level).
    """

    level = Parameter("1", "Stimulation while the gate is 1.", bounds=(-1, 1))
    gate = Input("1", "1 enables the stimulation; 0 disables it.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    @staticmethod
    def output(p, u, x, y):
        y.stimulation = u.gate * p.level
