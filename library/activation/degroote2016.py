import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, State


class DeGroote2016(Component):
    """Activation that rises faster than it falls, with a smooth transition between the two (De Groote et al. 2016).

    a' = [(0.5 + f) / (tau_act s) + (0.5 - f) s / tau_deact] (u - a), s = 0.5 + 1.5 a,
    f = 0.5 tanh(b (u - a)); u is clipped to [min, 1].
    """

    activation_time = Parameter(
        "ms", "tau_act: time constant of activation.", default=15, bounds=(0.1, 1000), source="degroote2016"
    )
    deactivation_time = Parameter(
        "ms", "tau_deact: time constant of deactivation.", default=60, bounds=(0.1, 1000), source="degroote2016"
    )
    smoothing = Parameter(
        "1",
        "b: sharpness of the transition. With 0.1, both rise and fall have about the mean of the time constants. With "
        "10, which OpenSim recommends but does not use by default, each has its own.",
        default=0.1,
        bounds=(0.01, 1000),
        source="degroote2016",
    )
    min_excitation = Parameter(
        "1",
        "Minimum excitation, so that the fiber never loses all force.",
        default=0.01,
        bounds=(0, 1),
        source="dembia2020: OpenSim's DeGrooteFregly2016Muscle",
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
        rising = 0.5 * math.tanh(p.smoothing * change)
        slowed = 0.5 + 1.5 * x.level
        rate = (0.5 + rising) / (p.activation_time * slowed) + (0.5 - rising) * slowed / p.deactivation_time
        x.level = x.level + rate * change * dt
