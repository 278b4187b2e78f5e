import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, State


class FirstOrder(Component):
    """Excitation-contraction coupling of first order: tau dA/dt = STIM - A, with STIM clipped to [min, 1]."""

    time_constant = Parameter("s", "Time constant tau.", default=0.01, bounds=(1e-4, 1), source="geyer2003")
    min_excitation = Parameter(
        "1",
        "Minimum excitation, so that the contractile element never loses all force.",
        default=0.01,
        bounds=(0, 1),
        source="geyer2003",
    )
    longest_substep = Parameter(
        "ms",
        "Longer steps are divided into equal substeps of at most this; the stimulation is extrapolated linearly.",
        default=0.5,
        bounds=(1e-3, 100),
        source="definition: a twentieth of the time constant",
    )
    excitation = Input("1", "Sum of all stimulations, STIM.", sums=True)
    level = State("1", "Activation A.")
    stimulation_before = State("1", "Clipped stimulation one step ago.")
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
        x.level = min(1.0, max(p.min_excitation, u.excitation))
        x.stimulation_before = x.level

    @staticmethod
    def output(p, u, x, y):
        y.activation = x.level

    @staticmethod
    def update(p, u, x, y, dt):
        stimulation = min(1.0, max(p.min_excitation, u.excitation))
        parts = max(1, math.ceil(min(1000.0, dt / p.longest_substep) - 1e-9))
        rise = (stimulation - x.stimulation_before) / parts
        for i in range(parts):
            present = min(1.0, max(p.min_excitation, stimulation + i * rise))
            x.level = x.level + (present - x.level) * (dt / parts) / p.time_constant
        x.stimulation_before = stimulation
