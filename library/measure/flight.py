import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class Flight(Component):
    """Flight in running: time without stance in each step, from one touchdown to the next of either leg."""

    settle = Parameter(
        "s", "Steps that begin earlier do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    left = Input("1", "1 while the left leg stands, such as {from: stance_l.in_stance}.")
    right = Input("1", "1 while the right leg stands.")

    steps = State("1", "Time steps since the start.")
    before = State("1", "Whether each leg stood in the last time step.", size=2)
    counting = State("1", "1 in a step that counts.")
    aloft = State("s", "Flight time in the present step.")
    total = State("s", "Flight time in all steps.")
    shortest = State("s", "Shortest flight in a step.")
    flights = State("1", "Number of steps with a flight phase.")
    count = State("1", "Number of steps.")

    value = Metric("1", "Share of steps with a flight phase.")
    duration = Metric("s", "Mean duration of flight in a step.")
    least = Metric("s", "Shortest flight of all steps; 0 if one has none.")

    @staticmethod
    def start(p, u, x):
        x.before[0] = u.left
        x.before[1] = u.right

    @staticmethod
    def update(p, u, x, y, dt):
        left = u.left > 0.5 and x.before[0] < 0.5
        right = u.right > 0.5 and x.before[1] < 0.5
        if left or right:
            if x.counting > 0.5:
                x.shortest = x.aloft if x.count < 0.5 else min(x.shortest, x.aloft)
                x.total = x.total + x.aloft
                x.flights = x.flights + (1.0 if x.aloft > 0 else 0.0)
                x.count = x.count + 1
            x.counting = 1.0 if x.steps * dt >= p.settle else 0.0
            x.aloft = 0.0
        if u.left < 0.5 and u.right < 0.5:
            x.aloft = x.aloft + dt
        x.before[0] = u.left
        x.before[1] = u.right
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = x.flights / x.count if x.count > 0 else math.nan
        m.duration = x.total / x.count if x.count > 0 else math.nan
        m.least = x.shortest if x.count > 0 else math.nan
