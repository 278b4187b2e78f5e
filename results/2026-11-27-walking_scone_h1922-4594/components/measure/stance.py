import math

from gaitsim.component import Component, Input, Metric, Output, Parameter, State


class Stance(Component):
    """Stance and swing of one leg from its load, and number of strides from touchdown to touchdown.

    A change counts once it has lasted for `hold`, so that neither a scuff in swing nor a bounce at touchdown
    counts as a step. Touchdown and take-off are both late by this time, so durations are correct.
    """

    threshold = Parameter(
        "1", "Load above which the leg stands.", default=0.05, bounds=(0, 1), source="definition: 5 % of body weight"
    )
    hold = Parameter("s", "Shorter changes are ignored.", default=0.02, bounds=(0, 1), source="definition: a bounce")
    load = Input("1", "Vertical ground reaction force in body weights.")

    phase = State(levels=("swing", "stance"), doc="Phase of the leg.")
    waiting = State("1", "Number of steps for which the load has contradicted the phase.")
    late = State("s", "Delay with which the last change was detected.")
    steps = State("1", "Steps since the start.")
    touchdowns = State("1", "Number of touchdowns so far.")
    first = State("s", "Time of the first touchdown.")
    last = State("s", "Time of the last touchdown.")

    in_stance = Output("1", "1 in stance, 0 in swing.")
    delay = Output("s", "Delay of in_stance.")

    value = Metric("1", "Number of whole strides.")
    stride_time = Metric("s", "Mean duration of a stride.")

    @staticmethod
    def start(p, u, x):
        x.phase = 1.0 if u.load > p.threshold else 0.0

    @staticmethod
    def output(p, u, x, y):
        y.in_stance = x.phase
        y.delay = x.late

    @staticmethod
    def update(p, u, x, y, dt):
        standing = 1.0 if u.load > p.threshold else 0.0
        x.waiting = x.waiting + 1 if standing != x.phase else 0.0
        x.steps = x.steps + 1
        # The tolerance keeps a whole number of steps whole in spite of rounding.
        if x.waiting > 0 and x.waiting * dt >= p.hold - 1e-6 * dt:
            x.late = x.waiting * dt
            x.waiting = 0.0
            x.phase = standing
            if standing > 0.5:
                x.last = x.steps * dt
                x.first = x.last if x.touchdowns < 0.5 else x.first
                x.touchdowns = x.touchdowns + 1

    @staticmethod
    def finish(p, x, m):
        m.value = max(0.0, x.touchdowns - 1)
        m.stride_time = (x.last - x.first) / m.value if m.value > 0 else math.nan
