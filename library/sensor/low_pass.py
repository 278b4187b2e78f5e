import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, State


class LowPass(Component):
    """First-order low-pass filter of a signal: tau x' = u - x. It starts at the value of the signal."""

    time_constant = Parameter("s", "tau.", bounds=(1e-6, 100))
    signal = Input("*", "Any signal.")
    followed = State("*", "The filtered signal.")
    filtered = Output("*", "The signal that follows.")

    step_response = Curve(
        "filtered", "time", (0, 0.2), "After a step, tau = 20 ms.", at={"time_constant": 0.02}, steps={"signal": (0, 1)}
    )

    @staticmethod
    def start(p, u, x):
        x.followed = u.signal

    @staticmethod
    def output(p, u, x, y):
        y.filtered = x.followed

    @staticmethod
    def update(p, u, x, y, dt):
        x.followed = u.signal + (x.followed - u.signal) * math.exp(-dt / p.time_constant)
