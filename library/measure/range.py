from gaitsim.component import Component, Input, Metric, State


class Range(Component):
    """Range of a signal, and its drift at the end of the run."""

    signal = Input("*", "Any signal.")
    lowest = State("*", "Smallest value so far.")
    highest = State("*", "Largest value so far.")
    first = State("*", "Value at the start.")
    last = State("*", "Latest value.")

    value = Metric("*", "Highest minus lowest.")
    low = Metric("*", "Smallest value.")
    high = Metric("*", "Largest value.")
    change = Metric("*", "Latest minus first value.")

    @staticmethod
    def start(p, u, x):
        x.lowest = u.signal
        x.highest = u.signal
        x.first = u.signal
        x.last = u.signal

    @staticmethod
    def update(p, u, x, y, dt):
        x.lowest = min(x.lowest, u.signal)
        x.highest = max(x.highest, u.signal)
        x.last = u.signal

    @staticmethod
    def finish(p, x, m):
        m.value = x.highest - x.lowest
        m.low = x.lowest
        m.high = x.highest
        m.change = x.last - x.first
