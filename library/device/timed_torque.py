from gaitsim.component import Component, Curve, Input, Link, Output, Parameter, State

from ._profile import swell


class TimedTorque(Component):
    """A torque over the time since an event, such as touchdown: it rises smoothly to a peak and falls again.

    Four numbers, after Zhang et al. (2017), whose text was not checked: peak torque, its time, rise and fall time. Rise
    and fall follow 3 s^2 - 2 s^3, which is flat at both ends. Before the first event there is no torque.
    """

    peak = Parameter("N m", "Torque at the peak; negative for the opposite direction.", bounds=(-1e4, 1e4))
    peak_time = Parameter("s", "Time of the peak after the event.", bounds=(0, 1e4))
    rise = Parameter("s", "Time from the onset to the peak.", bounds=(1e-3, 1e4))
    fall = Parameter("s", "Time from the peak to the end.", bounds=(1e-3, 1e4))
    joint = Link("The joint that the device acts on; replaces to:.", sends=(("moment", "moment"),))
    event = Input("1", "1 in the instant of the event, else 0.")
    steps = State("1", "Steps since the last event; -1 before the first.")
    since = State("s", "Time since the last event.")
    moment = Output("N m", "Moment in the direction of increasing joint angle.")

    profile = Curve(
        "moment",
        "since",
        (0, 1),
        "Torque over the time since touchdown.",
        at={"peak": 40, "peak_time": 0.5, "rise": 0.3, "fall": 0.1, "steps": 1},
    )

    @staticmethod
    def start(p, u, x):
        x.steps = -1.0

    @staticmethod
    def output(p, u, x, y):
        began = x.steps > -0.5
        y.moment = p.peak * swell(x.since, p.peak_time, p.rise, p.fall) if began else 0.0 * p.peak

    @staticmethod
    def update(p, u, x, y, dt):
        if u.event > 0.5:
            x.steps = 1.0
        elif x.steps > -0.5:
            x.steps = x.steps + 1
        x.since = max(0.0, x.steps) * dt
