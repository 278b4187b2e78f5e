from gaitsim.component import Attachment, Component, Curve, Input, Output, Parameter, Refused


def stop_torque(depth, rate, stiffness, damping):
    """Torque of a spring and a damper in parallel at a depth > 0; directed out of the stop, never into it."""
    return max(0.0, stiffness * depth + damping * rate) if depth > 0 else 0.0


class LimitedHinge(Component):
    """A hinge in the sagittal plane, about the y axis, with a soft stop at either end of its range.

    A positive angle turns a hanging child backwards, as in knee flexion. A stop is a spring and a damper
    in parallel. It acts beyond the limit only, and never pulls into it.
    """

    parent = Attachment("The frame that holds the hinge.")
    child = Attachment("The frame that turns.")
    lower = Parameter("rad", "Angle at which the lower stop begins.", bounds=(-6.3, 6.3))
    upper = Parameter("rad", "Angle at which the upper stop begins.", bounds=(-6.3, 6.3))
    stiffness = Parameter("N m/rad", "Stiffness of a stop.", bounds=(0, 1e6))
    stop_damping = Parameter(
        "N m s/rad", "Damping of a stop.", default=0, bounds=(0, 1e5), source="definition: an elastic stop"
    )
    damping = Parameter(
        "N m s/rad",
        "Viscous damping at all angles.",
        default=0,
        bounds=(0, 1000),
        source="definition: an ideal hinge",
    )
    torque = Input("N m", "Torque on the child about the hinge's axis.", sums=True)
    angle = Output(
        "rad",
        "Angle from the posture in which the two frames are aligned.",
        usual=("lower - 0.1", "upper + 0.1"),
        possible=("lower - pi / 2", "upper + pi / 2"),
    )
    velocity = Output("rad/s", "Angular velocity.")
    stop = Output("N m", "Torque of the stops on the child; positive at the lower one.")
    stop_energy = Output("J", "Elastic energy in the stops.", usual=(0, 5), possible=(0, 1000))
    total = Output("N m", "Sum of the torques of stops and of connected parts.")

    stops = Curve(
        "stop",
        "angle",
        (0.2, 2.7),
        "Torque of stops at 30 and 140 deg, 2 kN m/rad with 40 N m s/rad.",
        at={"lower": 0.524, "upper": 2.443, "stiffness": 2000, "stop_damping": 40},
        each=("velocity", (-5, 0, 5)),
    )

    @staticmethod
    def output(p, u, x, y):
        below, above = p.lower - y.angle, y.angle - p.upper
        y.stop = stop_torque(below, -y.velocity, p.stiffness, p.stop_damping) - stop_torque(
            above, y.velocity, p.stiffness, p.stop_damping
        )
        y.stop_energy = 0.5 * p.stiffness * (max(0.0, below) ** 2 + max(0.0, above) ** 2)
        y.total = y.stop + u.torque

    @staticmethod
    def build(p, mj):
        if not p.lower < p.upper:
            raise Refused(f"lower {p.lower:g} rad is not below upper {p.upper:g} rad; change one")
        joint = mj.hinge(axis=(0, 1, 0), damping=p.damping, limits=(p.lower, p.upper))
        mj.read("angle", joint, "qpos")
        mj.read("velocity", joint, "qvel")
        mj.apply("total", joint, "qfrc_applied")
