from gaitsim.component import Component, Input, Output


class MotorNerve(Component):
    """Carries an excitation to a muscle, as late as its connection says: `excitation: {from: ..., delay: 5 ms}`."""

    excitation = Input("1", "What leaves the spinal cord.")
    arriving = Output("1", "What arrives.")

    @staticmethod
    def output(p, u, x, y):
        y.arriving = u.excitation
