import math

from gaitsim.component import Component, Input, Metric, Output, Parameter, State


class Effort(Component):
    """Integral over time of a power of a muscle's excitation or activation, such as its square or cube.

    A further part sums several muscles: `to: effort.signal`, with `effort: {use: measure/total}`.
    """

    exponent = Parameter(
        "1",
        "Exponent of the signal, such as 2 or 3.",
        default=2,
        bounds=(1, 10),
        source="definition: squared is the usual choice",
    )
    weight = Parameter(
        "1",
        "Weight of this muscle, such as its share of all volume.",
        default=1,
        bounds=(0, 1e6),
        source="definition: all muscles equal",
    )
    signal = Input("1", "Excitation or activation, 0 to 1.")

    total = State("s", "Integral so far.")
    time = State("s", "Time since the start.")
    rate = Output("1", "Weight times the signal to the exponent.")

    value = Metric("s", "Integral over the run.")
    mean = Metric("1", "Integral over the duration of the run.")

    @staticmethod
    def output(p, u, x, y):
        y.rate = p.weight * max(0.0, u.signal) ** p.exponent

    @staticmethod
    def update(p, u, x, y, dt):
        x.total = x.total + y.rate * dt
        x.time = x.time + dt

    @staticmethod
    def finish(p, x, m):
        m.value = x.total
        m.mean = x.total / x.time if x.time > 0 else math.nan
