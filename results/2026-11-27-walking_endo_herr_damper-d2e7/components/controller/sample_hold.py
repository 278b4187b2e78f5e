from gaitsim.component import Component, Input, Output, State


class SampleHold(Component):
    """Holds the value of a signal at the last event; before the first event, its value at the start."""

    signal = Input("*", "Any signal.")
    event = Input("1", "1 in the instant of the event, else 0.")
    kept = State("*", "The signal at the last event.")
    held = Output("*", "The signal at the last event; in the instant of an event, its present value.")

    @staticmethod
    def start(p, u, x):
        x.kept = u.signal

    @staticmethod
    def output(p, u, x, y):
        y.held = u.signal if u.event > 0.5 else x.kept

    @staticmethod
    def update(p, u, x, y, dt):
        x.kept = y.held
