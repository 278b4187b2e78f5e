import math

from gaitsim.component import Component, Input, Metric, Parameter, Series, State


class GaitCurve(Component):
    """Comparison of a signal over the gait cycle with a recorded curve.

    Each stride, from touchdown to touchdown, is resampled at 101 points, 0 to 100 %. The mean over strides is
    compared. `stance` is late by `delay`, so the record of a stride begins late by as much; the missing
    beginning is taken from its end, where the next stride begins.
    """

    curve = Series("*", "Recorded curve over the gait cycle, from touchdown to touchdown.", size=101)
    settle = Parameter(
        "s", "Strides that begin earlier do not count.", default=2, bounds=(0, 1e3), source="definition: two strides"
    )
    direction = Parameter(
        "1",
        "-1 if the signal has the opposite sign convention.",
        default=1,
        bounds=(-1, 1),
        source="definition: as is",
        whole=True,
    )
    zero = Parameter("*", "Value of the signal at which the curve is 0.", default=0, source="definition: as is")
    signal = Input("*", "Signal, such as the angle of a joint.", like="curve")
    stance = Input("1", "1 while the leg stands, such as {from: stance_r.in_stance}.")
    delay = Input("s", "Delay of stance, such as {from: stance_r.delay}.", default=0)

    # One sample every `every` steps; when the array is full, every second sample is dropped and `every` doubles.
    samples = State("*", "The signal in the present stride.", size=512)
    filled = State("1", "Number of samples.")
    every = State("1", "Steps from one sample to the next.")
    since = State("1", "Steps since the last sample.")
    begun = State("1", "Number of steps before the present stride.")
    counting = State("1", "1 in a stride that counts.")
    steps = State("1", "Steps since the start.")
    before = State("1", "Whether the leg stood in the last step.")
    total = State("*", "Sum of the strides at 101 points.", size=101)
    strides = State("1", "Number of strides that count.")

    value = Metric("1", "Correlation of the mean stride with the recorded curve.")
    error = Metric("*", "Root mean square of their difference.", like="curve")
    shape_error = Metric("*", "The same after subtracting the mean of each.", like="curve")
    reach = Metric("*", "Highest minus lowest value of the mean stride.", like="curve")
    highest = Metric("*", "Highest value of the mean stride.", like="curve")
    highest_at = Metric("%", "Phase of that value.")
    lowest = Metric("*", "Lowest value of the mean stride.", like="curve")
    lowest_at = Metric("%", "Phase of that value.")

    @staticmethod
    def start(p, u, x):
        x.before = u.stance

    @staticmethod
    def update(p, u, x, y, dt):
        if u.stance > 0.5 and x.before < 0.5:
            if x.counting > 0.5:
                # Samples are at 0, 1, 2 ... times `every`; the stride ends after `long` samples.
                long = (x.steps - x.begun) / x.every
                late = u.delay / (dt * x.every)
                last = x.filled - 1
                for i in range(101):
                    at = 0.01 * i * long - late
                    at = at + long if at < 0 else at
                    left = max(0.0, min(math.floor(at), last - 1))
                    rest = min(1.0, at - left)
                    one, two = x.samples[int(left)], x.samples[int(left) + 1]
                    x.total[i] = x.total[i] + one + rest * (two - one)
                x.strides = x.strides + 1
            x.counting = 1.0 if x.steps * dt >= p.settle else 0.0
            x.begun = x.steps
            x.filled = 0.0
            x.every = 1.0
            x.since = 0.0
        if x.counting > 0.5:
            if x.since < 0.5:
                if x.filled > 511.5:
                    for i in range(256):
                        x.samples[i] = x.samples[2 * i]
                    x.filled = 256.0
                    x.every = 2 * x.every
                x.samples[int(x.filled) % 512] = p.direction * (u.signal - p.zero)
                x.filled = x.filled + 1
                x.since = x.every
            x.since = x.since - 1
        x.before = u.stance
        x.steps = x.steps + 1

    @staticmethod
    def finish(p, x, m):
        m.value = math.nan
        m.error = math.nan
        m.shape_error = math.nan
        m.reach = math.nan
        m.highest = math.nan
        m.lowest = math.nan
        m.highest_at = math.nan
        m.lowest_at = math.nan
        if x.strides > 0:
            mean, other = 0.0, 0.0
            for i in range(101):
                mean = mean + x.total[i] / (101 * x.strides)
                other = other + p.curve[i] / 101
            top, bottom, at_top, at_bottom = -math.inf, math.inf, 0, 0
            square, squares, product, difference = 0.0, 0.0, 0.0, 0.0
            for i in range(101):
                now = x.total[i] / x.strides
                at_top = i if now > top else at_top
                at_bottom = i if now < bottom else at_bottom
                top = max(top, now)
                bottom = min(bottom, now)
                square = square + (now - mean) ** 2
                squares = squares + (p.curve[i] - other) ** 2
                product = product + (now - mean) * (p.curve[i] - other)
                difference = difference + (now - p.curve[i]) ** 2
            if top > bottom and squares > 0:
                m.value = product / (math.sqrt(square) * math.sqrt(squares))
            m.error = math.sqrt(difference / 101)
            m.shape_error = math.sqrt(max(0.0, difference / 101 - (mean - other) ** 2))
            m.reach = top - bottom
            m.highest = top
            m.lowest = bottom
            m.highest_at = 0.01 * at_top
            m.lowest_at = 0.01 * at_bottom
