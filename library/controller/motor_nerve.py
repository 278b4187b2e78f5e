from gaitsim.component import Component, Input, Output


class MotorNerve(Component):
    """Passes an excitation to a muscle with the delay of its connection: `excitation: {from: ..., delay: 5 ms}`."""

    excitation = Input("1", "Excitation that leaves the spinal cord.")
    arriving = Output("1", "Excitation that arrives at the muscle.")

    @staticmethod
    def output(p, u, x, y):
        y.arriving = u.excitation
