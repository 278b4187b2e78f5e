from gaitsim.component import Component, Curve, Input, Output, Parameter


class Skeleton(Component):
    """Stimulation from a signal beyond a threshold, s = s_0 + G max(0, P - P_0); replace it by your equations."""

    gain = Parameter("1", "G: stimulation per unit of the signal.", default=3, bounds=(-100, 100), source="geyer2003")
    threshold = Parameter(
        "1", "P_0: threshold; smaller signals have no effect.", default=0, bounds=(-10, 10), source="definition: none"
    )
    bias = Parameter("1", "s_0: stimulation without a signal.", default=0.01, bounds=(0, 1), source="geyer2003")
    signal = Input("1", "A normalized signal, such as the force of a muscle.")
    gate = Input("1", "1 enables the feedback; at 0 only the bias remains.", default=1)
    stimulation = Output("1", "Contribution to a muscle's excitation.")

    answer = Curve("stimulation", "signal", (0, 1.5), "Stimulation over the signal.", each=("gate", (1, 0)))

    @staticmethod
    def output(p, u, x, y):
        y.stimulation = p.bias + u.gate * p.gain * max(0.0, u.signal - p.threshold)
