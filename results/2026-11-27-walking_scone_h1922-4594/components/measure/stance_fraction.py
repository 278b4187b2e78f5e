import math

from gaitsim.component import Component, Input, Metric, Parameter, State


class StanceFraction(Component):
    """Shares of the stride in stance, double support and flight, over whole strides."""

    settle = Parameter(
        "s", "Strides that begin earlier do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    left = Input("1", "1 while the left leg stands, such as {from: stance_l.in_stance}.")
    right = Input("1", "1 while the right leg stands.", default=0)

    steps = State("1", "Steps since the start.")
    before = State("1", "Whether each leg stood in the last step.", size=2)
    counting = State("1", "1 for each leg that is in a stride that counts.", size=2)
    stride = State("s", "Duration of the present stride of each leg.", size=2)
    stance = State("s", "Time in stance of the present stride.", size=2)
    both = State("s", "Time in which both legs stood in it.", size=2)
    none = State("s", "Time in which no leg stood in it.", size=2)
    strides = State("s", "Duration of all whole strides of each leg.", size=2)
    stances = State("s", "Time in stance of them.", size=2)
    boths = State("s", "Time in which both legs stood in them.", size=2)
    nones = State("s", "Time in which no leg stood in them.", size=2)

    value = Metric("1", "Share of stance, over the strides of both legs.")
    left_fraction = Metric("1", "Share of stance of the left leg.")
    right_fraction = Metric("1", "Share of stance of the right leg.")
    double_support = Metric("1", "Share of the stride in which both legs stand, twice in a stride.")
    flight = Metric("1", "Share of the stride in which no leg stands.")

    @staticmethod
    def start(p, u, x):
        x.before[0] = u.left
        x.before[1] = u.right

    @staticmethod
    def update(p, u, x, y, dt):
        for i in range(2):
            now = u.left if i == 0 else u.right
            other = u.right if i == 0 else u.left
            if now > 0.5 and x.before[i] < 0.5:
                if x.counting[i] > 0.5:
                    x.strides[i] = x.strides[i] + x.stride[i]
                    x.stances[i] = x.stances[i] + x.stance[i]
                    x.boths[i] = x.boths[i] + x.both[i]
                    x.nones[i] = x.nones[i] + x.none[i]
                x.stride[i] = 0.0
                x.stance[i] = 0.0
                x.both[i] = 0.0
                x.none[i] = 0.0
                x.counting[i] = 1.0 if x.steps * dt >= p.settle else 0.0
            x.stride[i] = x.stride[i] + dt
            x.stance[i] = x.stance[i] + (dt if now > 0.5 else 0.0)
            x.both[i] = x.both[i] + (dt if now > 0.5 and other > 0.5 else 0.0)
            x.none[i] = x.none[i] + (dt if now < 0.5 and other < 0.5 else 0.0)
            x.before[i] = now
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        whole = x.strides[0] + x.strides[1]
        m.value = (x.stances[0] + x.stances[1]) / whole if whole > 0 else math.nan
        m.left_fraction = x.stances[0] / x.strides[0] if x.strides[0] > 0 else math.nan
        m.right_fraction = x.stances[1] / x.strides[1] if x.strides[1] > 0 else math.nan
        m.double_support = (x.boths[0] + x.boths[1]) / whole if whole > 0 else math.nan
        m.flight = (x.nones[0] + x.nones[1]) / whole if whole > 0 else math.nan
