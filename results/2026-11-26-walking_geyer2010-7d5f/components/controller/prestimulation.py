from gaitsim.component import Component, Input, Output, Parameter


class Prestimulation(Component):
    """A constant stimulation while its gate is open.

    In Geyer & Herr (2010): S_0,BAL of the hip's muscles in stance; dS, which the hip flexors gain
    and the glutei lose (a negative level) in double support.
    """

    level = Parameter("1", "Stimulation while the gate is 1.", bounds=(-1, 1))
    gate = Input("1", "1 lets the stimulation through, 0 leaves nothing.", default=1)
    stimulation = Output("1", "Contribution to the muscle's excitation.")

    @staticmethod
    def output(p, u, x, y):
        y.stimulation = u.gate * p.level
