from gaitsim.component import Component, Curve, Input, Output, Parameter, State


class Skeleton(Component):
    """A signal that is measured with a lag, tau ds/dt = u - s; replace it by your equations."""

    time_constant = Parameter(
        "s", "tau: time constant.", default=0.02, bounds=(1e-4, 10), source="definition: a starting value"
    )
    signal = Input("1", "Signal that is measured.")
    level = State("1", "Measured value.")
    measured = Output("1", "Measured value.")

    response = Curve(
        "measured", "time", (0, 0.3), "Response to a signal that is switched on and off.", steps={"signal": (0, 1, 0)}
    )

    @staticmethod
    def start(p, u, x):
        x.level = u.signal

    @staticmethod
    def output(p, u, x, y):
        y.measured = x.level

    @staticmethod
    def update(p, u, x, y, dt):
        x.level = x.level + (u.signal - x.level) * dt / p.time_constant
