from gaitsim.component import Component, Input, Output


class Single(Component):
    """Hands a torque on."""

    force = Input("N m", "One torque.")
    torque = Output("N m", "The same.")

    @staticmethod
    def output(p, u, x, y):
        y.torque = u.force
