from gaitsim.component import Component, Curve, Input, Link, Output, Parameter, State


class VariableDamper(Component):
    """A damper parallel to a joint whose damping is commanded, as in a microprocessor-controlled prosthetic knee.

    Endo, Paluska & Herr (2006) had variable dampers besides springs and clutches. Their law is not available to us, so
    this one is our own: M = -c b phi', with the command c clipped to [0, 1]. It brakes one direction of movement or
    both. It takes energy from the joint and never gives any. The device has no mass.
    """

    damping = Parameter("N m s/rad", "b: moment per angular velocity at a command of 1.", bounds=(0, 1000))
    direction = Parameter(
        "1",
        "1: brakes while the joint angle grows; -1: while it falls; 0: both.",
        default=0,
        bounds=(-1, 1),
        source="definition: a plain damper",
        whole=True,
    )
    joint = Link(
        "The joint that the device spans; replaces angular_velocity: and to:.",
        reads=(("angular_velocity", "angular_velocity"),),
        sends=(("moment", "moment"),),
    )
    angular_velocity = Input("rad/s", "Angular velocity of the joint.")
    command = Input(
        "1", "Share of the damping that acts, clipped to [0, 1]; without a command, all.", default=1, sums=True
    )
    taken = State("J", "Total energy that the damper took from the joint.")
    moment = Output("N m", "Moment in the direction of increasing joint angle.")
    dissipated_power = Output("W", "Power that the damper takes from the joint, at least 0.")
    dissipated_energy = Output("J", "Energy that it took since the start.")

    braking = Curve(
        "moment",
        "angular_velocity",
        (-6, 6),
        "Moment over the angular velocity, 5 N m s/rad that brake growing angles, at commands of 1 and 0.5.",
        at={"damping": 5, "direction": 1},
        each=("command", (1, 0.5)),
    )

    @staticmethod
    def output(p, u, x, y):
        braked = p.direction * u.angular_velocity >= 0
        share = max(0.0, min(1.0, u.command)) if braked else 0.0
        y.moment = -share * p.damping * u.angular_velocity
        y.dissipated_power = -y.moment * u.angular_velocity
        y.dissipated_energy = x.taken

    @staticmethod
    def update(p, u, x, y, dt):
        x.taken = x.taken + y.dissipated_power * dt
