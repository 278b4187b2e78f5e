import math

from gaitsim.component import Component, Input, Metric, Output, Parameter, State


class Stance(Component):
    """Tells stance from swing of one leg by its load, and counts strides from touchdown to touchdown.

    A change counts once it has lasted for `hold`, so that neither a scuff in swing nor a bounce at
    touchdown is a step. Touchdown and take-off are both told that much late: durations are right.
    """

    threshold = Parameter(
        "1", "A leg with more load stands.", default=0.05, bounds=(0, 1), source="definition: 5 % of body weight"
    )
    hold = Parameter(
        "s", "A change of shorter duration is none.", default=0.02, bounds=(0, 1), source="definition: a bounce"
    )
    load = Input("1", "Vertical ground reaction force in body weights.")

    phase = State(levels=("swing", "stance"), doc="Phase of the leg.")
    waiting = State("1", "Steps for which the load has said otherwise.")
    late = State("s", "By how much the last change was told late.")
    steps = State("1", "Steps since the start.")
    touchdowns = State("1", "How many touchdowns there were.")
    first = State("s", "Time of the first touchdown.")
    last = State("s", "Time of the last one.")

    in_stance = Output("1", "1 in stance, 0 in swing.")
    delay = Output("s", "By how much in_stance is late.")

    value = Metric("1", "Number of whole strides.")
    stride_time = Metric("s", "Their mean duration.")

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
        # A whole number of steps that rounding made a little longer is still that number.
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
