from gaitsim.component import Component, Output, Parameter, State


class Switch(Component):
    """One stimulation, then another, then the first again."""

    low = Parameter("1", "The first.", default=0.01, bounds=(0, 1), source="definition: a choice")
    high = Parameter("1", "The other.", default=1, bounds=(0, 1), source="definition: a choice")
    on = Parameter("s", "When the other begins.", default=0.05, bounds=(0, 10), source="definition: a choice")
    off = Parameter("s", "When it ends.", default=0.25, bounds=(0, 10), source="definition: a choice")
    steps = State("1", "Steps since the start.")
    clock = State("s", "Time since the start.")
    stimulation = Output("1", "Stimulation of a muscle.")

    @staticmethod
    def output(p, u, x, y):
        y.stimulation = p.high if p.on <= x.clock < p.off else p.low

    @staticmethod
    def update(p, u, x, y, dt):
        x.steps = x.steps + 1
        x.clock = x.steps * dt
