from gaitsim.component import Component, Curve, Input, Link, Output, Parameter, State

from ._profile import swell


class PhaseTorque(Component):
    """A torque over the phase of the stride: it rises smoothly to a peak and falls again.

    Four numbers in shares of the stride, after Zhang et al. (2017), whose text was not checked: peak torque, its
    phase, rise and fall.
    The phase is the time since the last touchdown divided by the duration of the previous stride; it stays below 1
    until the next touchdown. There is no torque before the second touchdown.
    """

    peak = Parameter("N m", "Torque at the peak; negative for the opposite direction.", bounds=(-1e4, 1e4))
    peak_phase = Parameter("1", "Phase of the peak, as a share of the stride.", bounds=(0, 1))
    rise = Parameter("1", "From the onset to the peak, as a share of the stride.", bounds=(1e-3, 1))
    fall = Parameter("1", "From the peak to the end, as a share of the stride.", bounds=(1e-3, 1))
    joint = Link("The joint that the device acts on; replaces to:.", sends=(("moment", "moment"),))
    touchdown = Input("1", "1 in the instant of a touchdown of the leg, else 0.")
    events = State("1", "Touchdowns so far.")
    steps = State("1", "Steps since the last touchdown.")
    stride = State("1", "Steps of the last whole stride.")
    phase = State("1", "Phase of the stride.")
    moment = Output("N m", "Moment in the direction of increasing joint angle.")

    profile = Curve(
        "moment",
        "phase",
        (0, 1),
        "Torque over the stride.",
        at={"peak": 40, "peak_phase": 0.5, "rise": 0.25, "fall": 0.1, "events": 2},
    )

    @staticmethod
    def output(p, u, x, y):
        known = x.events > 1.5
        y.moment = p.peak * swell(x.phase, p.peak_phase, p.rise, p.fall) if known else 0.0 * p.peak

    @staticmethod
    def update(p, u, x, y, dt):
        x.steps = x.steps + 1
        if u.touchdown > 0.5:
            x.stride = x.steps - 1 if x.events > 0.5 else 0.0
            x.events = x.events + 1
            x.steps = 1.0
        x.phase = min(x.steps / x.stride, 1.0) if x.stride > 0.5 else 0.0
