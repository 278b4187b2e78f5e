from gaitsim.component import Component, Input, Output


class Direct(Component):
    """Hands the excitation on."""

    excitation = Input("N", "A force.", sums=True)
    activation = Output("1", "Activation.")

    @staticmethod
    def output(p, u, x, y):
        y.activation = 1.0
