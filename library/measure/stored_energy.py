import math

from gaitsim.component import Component, Input, Metric, State


class StoredEnergy(Component):
    """Elastic energy at the start of the run, and the height to which it could lift the model."""

    energy = Input("J", "Sum of elastic energies, such as {from: elastic.total}.")
    weight = Input("N", "Weight of the whole model, such as {from: elastic.weight}.")
    stored = State("J", "Energy at the start.")
    lifted = State("N", "Weight at the start.")

    value = Metric("m", "Energy at the start over the weight; nan without gravity.")
    energy_at_start = Metric("J", "Energy at the start.")

    @staticmethod
    def start(p, u, x):
        x.stored = u.energy
        x.lifted = u.weight

    @staticmethod
    def finish(p, x, m):
        m.energy_at_start = x.stored
        m.value = x.stored / x.lifted if x.lifted > 0 else math.nan
