from gaitsim.component import Component, Input, Output, State


class Relay(Component):
    """A relay that forgets to say when it switches."""

    angle = Input("rad", "Angle.")
    side = State("1", "Which side it is on.")
    torque = Output("N m", "Torque.")

    @staticmethod
    def output(p, u, x, y):
        y.torque = 1.0 if x.side > 0.5 else -1.0

    @staticmethod
    def reset(p, u, x, y, t):
        x.side = 1.0 - x.side
