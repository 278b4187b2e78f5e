import math

from gaitsim.component import Component, Input, Metric, Output, Parameter, State


class Section(Component):
    """Poincaré section: the value of a signal at the instants when another signal crosses 0, located within the step.

    For an apex, the upward velocity falls through 0; for the largest compression of a spring, the rate of its
    length rises through 0. With `stop_after` the run ends there.
    """

    direction = Parameter(
        "1", "1 for rising crossings, -1 for falling ones.", default=1, bounds=(-1, 1), source="definition", whole=True
    )
    stop_after = Parameter(
        "1",
        "Number of crossings after which the run ends; 0: never.",
        default=0,
        bounds=(0, 1e9),
        source="definition: never",
        whole=True,
    )
    signal = Input("*", "Signal that is recorded at the crossing.")
    crossing = Input("*", "Continuous signal whose zero crossings define the section.")

    first_signal = State("*", "The signal at the first crossing.")
    last_signal = State("*", "The signal at the last crossing.")
    first_time = State("s", "Time of the first crossing.")
    last_time = State("s", "Time of the last crossing.")
    duration = State("s", "Time between the last two crossings.")
    count = State("1", "Number of crossings so far.")

    guard = Output("*", "Rises through 0 at a crossing.")
    stop = Output("1", "1 after the last requested crossing.")

    value = Metric("*", "The signal at the last crossing.")
    first = Metric("*", "The signal at the first crossing.")
    period = Metric("s", "Time between the last two crossings; with a single one, its time.")
    passages = Metric("1", "Number of crossings.")

    @staticmethod
    def output(p, u, x, y):
        y.guard = u.crossing if p.direction > 0 else -u.crossing
        y.stop = 1.0 if p.stop_after > 0.5 and x.count >= p.stop_after else 0.0

    @staticmethod
    def reset(p, u, x, y, t):
        if x.count < 0.5:
            x.first_signal = u.signal
            x.first_time = t
        x.duration = t - x.last_time
        x.last_signal = u.signal
        x.last_time = t
        x.count = x.count + 1

    @staticmethod
    def finish(p, x, m):
        m.passages = x.count
        m.value = x.last_signal if x.count > 0 else math.nan
        m.first = x.first_signal if x.count > 0 else math.nan
        m.period = x.duration if x.count > 0 else math.nan
