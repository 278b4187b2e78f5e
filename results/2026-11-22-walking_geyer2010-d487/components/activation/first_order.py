from gaitsim.component import Component, Curve, Input, Output, Parameter, State


class FirstOrder(Component):
    """Excitation-contraction coupling of first order: tau dA/dt = STIM - A, with STIM clipped to [min, 1]."""

    time_constant = Parameter("s", "Time constant tau.", default=0.01, bounds=(1e-4, 1), source="geyer2003")
    min_excitation = Parameter(
        "1",
        "Least excitation; keeps the contractile element from losing all force.",
        default=0.01,
        bounds=(0, 1),
        source="geyer2003",
    )
    excitation = Input("1", "Sum of all stimulations, STIM.", sums=True)
    level = State("1", "Activation A.")
    activation = Output("1", "Activation A.")

    response = Curve(
        "activation", "time", (0, 0.15), "Answer to an excitation that comes and goes.", steps={"excitation": (0, 1, 0)}
    )

    @staticmethod
    def start(p, u, x):
        x.level = min(1.0, max(p.min_excitation, u.excitation))

    @staticmethod
    def output(p, u, x, y):
        y.activation = x.level

    @staticmethod
    def update(p, u, x, y, dt):
        stimulation = min(1.0, max(p.min_excitation, u.excitation))
        x.level = x.level + (stimulation - x.level) * dt / p.time_constant
