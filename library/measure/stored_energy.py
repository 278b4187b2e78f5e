import math

from gaitsim.component import Component, Input, Metric, State


class StoredEnergy(Component):
    """Elastic energy that is there before the run begins, and the height that it could lift the model to."""

    energy = Input("J", "Sum of elastic energies, such as {from: elastic.total}.")
    weight = Input("N", "Weight of all that moves, such as {from: elastic.weight}.")
    stored = State("J", "Energy at the start.")
    lifted = State("N", "Weight at the start.")

    value = Metric("m", "Energy at the start over the weight; nothing without gravity.")
    energy_at_start = Metric("J", "Energy at the start.")

    @staticmethod
    def start(p, u, x):
        x.stored = u.energy
        x.lifted = u.weight

    @staticmethod
    def finish(p, x, m):
        m.energy_at_start = x.stored
        m.value = x.stored / x.lifted if x.lifted > 0 else math.nan
