from gaitsim.component import Component, Curve, Input, Link, Output, Parameter, State


def stretch_of(angle, rest, direction):
    """Stretch of a spring that only pulls, as an angle of the joint."""
    return max(0.0, direction * (rest - angle))


class AnkleSpring(Component):
    """A spring parallel to a joint, with a slack angle and a clutch: a passive ankle exoskeleton.

    The spring only pulls, in the direction of increasing angle (direction 1): M = k max(0, phi_rest - phi). At an
    ankle whose angle grows with plantarflexion it thus helps the calf. Without a gate, phi_rest is the slack angle.
    With one, as in Collins, Wiggin & Sawicki (2015), the device is free while the clutch is released, as in swing.
    From the instant at which it engages, slack is taken up: phi_rest is the largest angle since then, at most the
    slack angle.

    The spring returns all energy except what it holds when the clutch is released; this loss is an output.
    The clutch is engaged while the gate is above one half. The device has no mass.
    """

    stiffness = Parameter("N m/rad", "k: moment per angle.", bounds=(0, 1e5))
    slack_angle = Parameter("deg", "Angle of the joint beyond which the spring is slack.", bounds=(-360, 360))
    direction = Parameter(
        "1",
        "1: the moment acts towards larger joint angles; -1: towards smaller ones.",
        default=1,
        bounds=(-1, 1),
        source="definition: plantarflexion adds to the ankle's angle in geyer2010",
        whole=True,
    )
    joint = Link(
        "The joint that the device spans; replaces angle: and to:.",
        reads=(("angle", "angle"),),
        sends=(("moment", "moment"),),
    )
    angle = Input("rad", "Joint angle.")
    gate = Input("1", "The clutch is engaged above one half; without a gate, always.", default=1)
    engaged = State(levels=("no", "yes"), doc="Whether the clutch was engaged one step ago.")
    rest = State("rad", "phi_rest: angle at which the spring is at rest.")
    dissipated = State("J", "Total energy that the spring held at releases of the clutch.")
    moment = Output("N m", "Moment in the direction of increasing joint angle.")
    stretch = Output("rad", "Stretch of the spring.")
    elastic_energy = Output("J", "Elastic energy of the spring.")
    dissipated_energy = Output("J", "Energy lost by releases under load since the start.")

    spring = Curve(
        "moment",
        "angle",
        (1.2, 2),
        "Moment over the ankle's angle, 180 N m/rad, slack from 95 deg on.",
        at={"stiffness": 180, "slack_angle": 95, "engaged": 1, "rest": 1.658},
        each=("gate", (1, 0)),
    )

    @staticmethod
    def start(p, u, x):
        x.engaged = 1 if u.gate > 0.5 else 0
        x.rest = p.slack_angle

    @staticmethod
    def output(p, u, x, y):
        held = u.gate > 0.5 and x.engaged > 0.5
        y.stretch = stretch_of(u.angle, x.rest, p.direction) if held else 0.0 * u.angle
        y.moment = p.direction * p.stiffness * y.stretch
        y.elastic_energy = 0.5 * p.stiffness * y.stretch**2
        y.dissipated_energy = x.dissipated

    @staticmethod
    def update(p, u, x, y, dt):
        engaged = u.gate > 0.5
        if x.engaged > 0.5 and not engaged:
            x.dissipated = x.dissipated + 0.5 * p.stiffness * stretch_of(u.angle, x.rest, p.direction) ** 2
        carries_on = engaged and x.engaged > 0.5
        taken_up = max(p.direction * x.rest, p.direction * u.angle) if carries_on else p.direction * u.angle
        x.rest = p.direction * min(p.direction * p.slack_angle, taken_up)
        x.engaged = 1 if engaged else 0
