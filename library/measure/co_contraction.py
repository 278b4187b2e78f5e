import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class CoContraction(Component):
    """Co-contraction of two muscle groups: the mean square of the smaller of their moments."""

    unit = Parameter(
        "N m", "Scale: the value is divided by this.", default=1, bounds=(1e-9, 1e9), source="definition: SI"
    )
    settle = Parameter(
        "s", "Samples before this time are ignored.", default=0, bounds=(0, 1e3), source="definition: the whole run"
    )
    opening = Input("N m", "Moments towards larger angles; their sum counts where positive.", sums=True)
    closing = Input("N m", "Moments towards smaller angles; their sum counts where negative.", sums=True)

    steps = State("1", "Steps since the start.")
    counted = State("1", "Steps that count.")
    total = State("1", "Sum of the squares over them.")

    value = Metric("1", "The mean square.")

    @staticmethod
    def update(p, u, x, y, dt):
        if x.steps * dt >= p.settle:
            x.counted = x.counted + 1
            smaller = max(0.0, min(u.opening, -u.closing)) / p.unit
            x.total = x.total + smaller * smaller
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = x.total / x.counted if x.counted > 0 else math.nan
