import math

from gaitsim.component import Component, Output, Refused, Series, State


def interpolated(time, times, values):
    """Linear interpolation between instants; constant before the first and after the last, behind which are nan."""
    found = values[0]
    for i in range(32):
        if time >= times[i]:
            found = values[i]
            if i < 31 and time < times[i + 1]:
                found = values[i] + (time - times[i]) / (times[i + 1] - times[i]) * (values[i + 1] - values[i])
    return found


class TimeProfile(Component):
    """A signal that a spec gives over time, such as the speed that a walker is asked for.

    It is linear between the instants of a list, and constant before the first and after the last.
    """

    times = Series("s", "Instants after the start, in increasing order.", size=32, listed=True)
    values = Series("*", "Values at these instants.", size=32, listed=True)
    steps = State("1", "Steps since the start.")
    time = State("s", "Time since the start.")
    value = Output("*", "Value of this instant.", like="values")

    @staticmethod
    def output(p, u, x, y):
        y.value = interpolated(x.time, p.times, p.values)

    @staticmethod
    def update(p, u, x, y, dt):
        x.steps = x.steps + 1
        x.time = x.steps * dt

    @staticmethod
    def build(p, mj):
        instants, values = (sum(math.isfinite(v) for v in each) for each in (p.times, p.values))
        if instants != values:
            raise Refused(f"there are {instants} times and {values} values; write one value for each instant")
