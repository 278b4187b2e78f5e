from gaitsim.component import Component, Curve, Input, Output, Parameter, State


class Skeleton(Component):
    """Activation that follows the excitation, dA/dt = (u - A) / tau; replace it by your equations."""

    time_constant = Parameter("s", "tau: time constant.", default=0.01, bounds=(1e-4, 1), source="geyer2003")
    excitation = Input("1", "Sum of all stimulations.", sums=True)
    level = State("1", "Activation A.")
    activation = Output("1", "Activation A.")

    response = Curve(
        "activation",
        "time",
        (0, 0.15),
        "Response to an excitation that is switched on and off.",
        steps={"excitation": (0, 1, 0)},
    )

    @staticmethod
    def start(p, u, x):
        x.level = min(1.0, max(0.01, u.excitation))

    @staticmethod
    def output(p, u, x, y):
        y.activation = x.level

    @staticmethod
    def update(p, u, x, y, dt):
        excitation = min(1.0, max(0.01, u.excitation))
        x.level = x.level + (excitation - x.level) * dt / p.time_constant
