from gaitsim.component import Component, Curve, Input, Output, Parameter, State


class ExcitationRate(Component):
    """Activation whose rate grows with the excitation (Geijtenbeek 2021): a' = (u - a) (c_1 u + c_2).

    c_1 + c_2 is the rate at full excitation, c_2 that of a muscle at rest; u is clipped to [min, 1].
    At little excitation it rises more slowly than activation/two_constants.
    """

    activation_rate = Parameter(
        "1/s", "c_1 + c_2: rate at full excitation.", default=100, bounds=(1, 2000), source="geijtenbeek2021"
    )
    deactivation_rate = Parameter(
        "1/s", "c_2: rate without excitation.", default=25, bounds=(0.1, 2000), source="geijtenbeek2021"
    )
    min_excitation = Parameter(
        "1", "Least excitation and activation.", default=0.01, bounds=(0, 1), source="geijtenbeek2019"
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
        excitation = min(1.0, max(p.min_excitation, u.excitation))
        rate = p.deactivation_rate + (p.activation_rate - p.deactivation_rate) * excitation
        x.level = x.level + (excitation - x.level) * rate * dt
