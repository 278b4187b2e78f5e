from gaitsim.component import Component, Input, Output, Parameter, State


class Driven(Component):
    """A path that is stretched, held, and released again, whatever pulls on it."""

    reference_length = Parameter("m", "Length at first.", bounds=(0, 3))
    rate = Parameter("m/s", "Velocity of both.", default=0, bounds=(-10, 10), source="definition: held")
    time = Parameter("s", "How long each takes.", default=0.05, bounds=(0, 10), source="definition: a choice")
    stretch = Parameter("s", "When stretching begins.", default=0.05, bounds=(0, 10), source="definition: a choice")
    release = Parameter("s", "When releasing begins.", default=0.2, bounds=(0, 10), source="definition: a choice")
    tension = Input("N", "Force along the path.", sums=True)
    steps = State("1", "Steps since the start.")
    clock = State("s", "Time since the start.")
    length = Output("m", "Length of the path.")
    velocity = Output("m/s", "Lengthening velocity of the path.")

    @staticmethod
    def output(p, u, x, y):
        longer = min(max(x.clock - p.stretch, 0.0), p.time)
        shorter = min(max(x.clock - p.release, 0.0), p.time)
        y.length = p.reference_length + p.rate * (longer - shorter)
        stretching = 1 if p.stretch <= x.clock < p.stretch + p.time else 0
        releasing = 1 if p.release <= x.clock < p.release + p.time else 0
        y.velocity = p.rate * (stretching - releasing)

    @staticmethod
    def update(p, u, x, y, dt):
        x.steps = x.steps + 1
        x.clock = x.steps * dt
