from gaitsim.component import Component, Curve, Input, Output, Parameter, State


class TwoConstants(Component):
    """Activation that rises faster than it falls (Thelen 2003; Millard et al. 2013): a' = (u - a) / tau.

    tau = tau_act (0.5 + 1.5 a) where it rises, tau_deact / (0.5 + 1.5 a) where it falls; u is clipped
    to [min, 1]. Thelen (2003) has 15 and 50 ms.
    """

    activation_time = Parameter(
        "ms", "tau_act: time constant of activation.", default=10, bounds=(0.1, 1000), source="millard2013"
    )
    deactivation_time = Parameter(
        "ms", "tau_deact: time constant of deactivation.", default=40, bounds=(0.1, 1000), source="millard2013"
    )
    min_excitation = Parameter(
        "1", "Minimum excitation and activation.", default=0.01, bounds=(0, 1), source="millard2013"
    )
    excitation = Input("1", "Sum of all stimulations, u.", sums=True)
    level = State("1", "Activation a.")
    activation = Output("1", "Activation a.")

    curve = Curve(
        of="activation",
        over="time",
        span=(0, 0.4),
        doc="Activation after steps of the excitation from 0 to 1 and back.",
        steps={"excitation": (0, 1, 0)},
    )

    @staticmethod
    def start(p, u, x):
        x.level = min(1.0, max(p.min_excitation, u.excitation))

    @staticmethod
    def output(p, u, x, y):
        y.activation = x.level

    @staticmethod
    def update(p, u, x, y, dt):
        change = min(1.0, max(p.min_excitation, u.excitation)) - x.level
        slowed = 0.5 + 1.5 * x.level
        tau = p.activation_time * slowed if change > 0 else p.deactivation_time / slowed
        x.level = x.level + change * dt / tau
