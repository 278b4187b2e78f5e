import math

from gaitsim.component import Component, Input, Metric, Output, Parameter, State


class Section(Component):
    """A signal in the instants at which another passes through 0: a Poincaré section, located within the step.

    An apex is where the upward velocity falls through 0, the greatest compression of a spring where the rate of its
    length rises through it. With `stop_after` the run ends there.
    """

    direction = Parameter(
        "1", "1 where the crossing rises through 0, -1 where it falls.", default=1, bounds=(-1, 1), source="definition"
    )
    stop_after = Parameter(
        "1", "After so many passages the run ends; 0: never.", default=0, bounds=(0, 1e9), source="definition: never"
    )
    signal = Input("*", "What is told of the instant.")
    crossing = Input("*", "A continuous signal.")

    first_signal = State("*", "The signal at the first passage.")
    last_signal = State("*", "The signal at the last one.")
    first_time = State("s", "When the first passage was.")
    last_time = State("s", "When the last one was.")
    duration = State("s", "From the last but one to the last.")
    count = State("1", "How many passages there were.")

    guard = Output("*", "Rises through 0 at a passage.")
    stop = Output("1", "1 after the last passage that is asked for.")

    value = Metric("*", "At the last passage.")
    first = Metric("*", "At the first passage.")
    period = Metric("s", "Time between the last two passages; up to the first, if there is one only.")
    passages = Metric("1", "Number of passages.")

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
