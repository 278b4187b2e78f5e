from gaitsim.component import Component, Curve, Input, Output, Parameter, Refused


class SpeedModulation(Component):
    """A value of a controller as a function of the speed that is asked for: a line, or a parabola.

    y = y_slow + (y_fast - y_slow) s + 4 b s (1 - s), where s goes from 0 at the slow speed to 1 at the fast one; beyond
    them y is constant. b is how far the parabola is above the line in the middle. That values of a reflex model change
    with the speed that is asked for is the idea of Song & Geyer (song2012) and Koseki et al. (koseki2024); the curve is
    a choice of ours.
    """

    slow = Parameter("m/s", "Slow speed.", bounds=(-10, 10))
    fast = Parameter("m/s", "Fast speed.", bounds=(-10, 10))
    at_slow = Parameter("*", "y_slow: value at the slow speed.")
    at_fast = Parameter("*", "y_fast: value at the fast speed.")
    bend = Parameter(
        "*", "b: how far the curve is above the line in the middle.", default=0, source="definition: a line"
    )
    speed = Input("m/s", "Speed that is asked for.")
    value = Output("*", "y: value at this speed.", like="at_slow")

    curve = Curve(
        "value",
        "speed",
        (0.6, 1.8),
        "Value over the speed, from 1 at 0.8 m/s to 2 at 1.6 m/s.",
        at={"slow": 0.8, "fast": 1.6, "at_slow": 1, "at_fast": 2},
        each=("bend", (0, 0.2)),
    )

    @staticmethod
    def output(p, u, x, y):
        share = max(0.0, min(1.0, (u.speed - p.slow) / (p.fast - p.slow)))
        y.value = p.at_slow + share * (p.at_fast - p.at_slow) + 4 * share * (1 - share) * p.bend

    @staticmethod
    def build(p, mj):
        if p.slow >= p.fast:
            raise Refused(f"slow is {p.slow:g} m/s and fast is {p.fast:g} m/s; fast must be the higher one")
