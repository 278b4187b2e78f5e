from gaitsim.component import Component, Input, Output, Parameter


class Ranged(Component):
    """Nothing, of an angle that is expected to be small."""

    highest = Parameter("1", "The largest usual angle.", default=0.1, bounds=(0, 7), source="definition: a test")
    signal = Input("rad", "An angle.", usual=(-0.1, "highest"))
    torque = Output("N m", "None.")

    @staticmethod
    def output(p, u, x, y):
        y.torque = 0 * u.signal
