import math

from gaitsim.component import Component, Output, Parameter, State


class Clock(Component):
    """A sine in time that starts at its phase."""

    rate = Parameter("rad/s", "Angular frequency.", default=20, source="definition: a test")
    phase = Parameter("rad", "Angle at the start.", default=0.5, source="definition: a test")
    steps = State("1", "Steps since the start.")
    time = State("s", "Time since the start.")
    signal = Output("1", "The sine.")

    @staticmethod
    def output(p, u, x, y):
        y.signal = math.sin(p.phase + p.rate * x.time)

    @staticmethod
    def update(p, u, x, y, dt):
        x.steps = x.steps + 1
        x.time = x.steps * dt
