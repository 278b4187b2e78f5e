import math

from gaitsim.component import Component, Input, Output, Parameter, Series


class RecordedMoment(Component):
    """Recorded moment of a joint over the cycle, and its difference from the moment of the muscles."""

    curve = Series("N m/kg", "Recorded moment over body mass, over the cycle.", size=101)
    mass = Parameter("kg", "Body mass.", bounds=(0.1, 1000))
    phase = Input("1", "Phase of the cycle, from 0 to 1.")
    muscle_moment = Input("N m", "Moment of the muscles.")

    moment = Output("N m", "The recorded moment.")
    lacking = Output("N m", "Recorded moment minus the moment of the muscles.")
    muscle_moment_per_mass = Output("N m/kg", "Moment of the muscles over body mass.")

    @staticmethod
    def output(p, u, x, y):
        place = 100 * (u.phase % 1)
        left = math.floor(min(99.0, max(0.0, place)))
        i = int(left)
        y.moment = p.mass * (p.curve[i] + (place - left) * (p.curve[i + 1] - p.curve[i]))
        y.lacking = y.moment - u.muscle_moment
        y.muscle_moment_per_mass = u.muscle_moment / p.mass
