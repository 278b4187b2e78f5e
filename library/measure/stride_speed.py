import math

from gaitsim.component import Component, Input, Metric, Output, Parameter, State


class StrideSpeed(Component):
    """Mean speed of each stride, and how far it is from the mean speed that was asked for during this stride."""

    settle = Parameter(
        "s", "Strides that begin earlier do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    position = Input("m", "Forward position, such as that of the pelvis.")
    asked = Input("m/s", "Speed that is asked for.")
    stance = Input("1", "1 while a leg stands, such as {from: stance_r.in_stance}; its touchdowns delimit the strides.")

    steps = State("1", "Steps since the start.")
    before = State("1", "Whether the leg stood in the last step.")
    began = State(levels=("no", "yes"), doc="Whether a stride has begun.")
    first = State("1", "Step at which the present stride began.")
    origin = State("m", "Position at which it began.")
    way = State("m", "Distance that was asked for since then.")
    last = State("m/s", "Speed of the last stride; 0 before the end of the first.")
    count = State("1", "Number of strides that counted.")
    total = State("m/s", "Sum of their speeds.")
    squares = State("m^2/s^2", "Sum of the squares of their errors.")
    lowest = State("m/s", "Smallest of their speeds.")
    highest = State("m/s", "Largest of their speeds.")
    largest = State("m/s", "Largest of their errors.")

    speed = Output("m/s", "Mean speed of the last stride; 0 before the end of the first.")

    value = Metric("m/s", "Mean of the speeds of strides.")
    error = Metric("m/s", "Root mean square of their differences from the speed that was asked for.")
    largest_error = Metric("m/s", "Largest of these differences.")
    slowest = Metric("m/s", "Speed of the slowest stride.")
    fastest = Metric("m/s", "Speed of the fastest stride.")

    @staticmethod
    def start(p, u, x):
        x.before = u.stance

    @staticmethod
    def output(p, u, x, y):
        y.speed = x.last

    @staticmethod
    def update(p, u, x, y, dt):
        if u.stance > 0.5 and x.before < 0.5:
            if x.began == 1:
                lasted = (x.steps - x.first) * dt
                x.last = (u.position - x.origin) / lasted
                if x.first * dt >= p.settle:
                    error = x.last - x.way / lasted
                    x.lowest = x.last if x.count < 0.5 else min(x.lowest, x.last)
                    x.highest = max(x.highest, x.last)
                    x.largest = max(x.largest, abs(error))
                    x.total = x.total + x.last
                    x.squares = x.squares + error * error
                    x.count = x.count + 1
            x.began = 1
            x.first = x.steps
            x.origin = u.position
            x.way = 0.0 * x.way
        x.way = x.way + u.asked * dt
        x.before = u.stance
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        none = x.count < 0.5
        m.value = math.nan if none else x.total / x.count
        m.error = math.nan if none else math.sqrt(x.squares / x.count)
        m.largest_error = math.nan if none else x.largest
        m.slowest = math.nan if none else x.lowest
        m.fastest = math.nan if none else x.highest
