import math

from gaitsim.component import Attachment, Component, Curve, Input, Output, Parameter, Refused


class SpatialHinge(Component):
    """A hinge about any axis, with a soft stop at either end of its range.

    The angle follows the right-hand rule about the axis. Several hinges with the same parent and
    child make one joint of as many degrees of freedom, such as a hip: the first turns the second, and
    both the third. On the left side the axis is mirrored, so that angles have the same meaning on both sides.

    A stop is a spring of a depth d > 0 beyond its end, with a damping that grows with depth (Hunt & Crossley 1975):
    M = k d (1 + k_w d'), never pulling back, solved for the velocity at the end of the step. A range without
    width, such as 0 to 0 deg, makes it a spring both ways.
    """

    parent = Attachment("The frame that holds the hinge.")
    child = Attachment("The frame that turns.")
    axis_forward = Parameter(
        "1", "Forward component of the axis.", default=0, bounds=(-1e3, 1e3), source="definition: no component"
    )
    axis_left = Parameter(
        "1", "Leftward component of the axis.", default=0, bounds=(-1e3, 1e3), source="definition: no component"
    )
    axis_up = Parameter(
        "1", "Upward component of the axis.", default=0, bounds=(-1e3, 1e3), source="definition: no component"
    )
    lower = Parameter(
        "deg",
        "Angle at which the lower stop begins.",
        default=-1e4,
        bounds=(-1e4, 1e4),
        source="definition: out of reach, no stop",
    )
    upper = Parameter(
        "deg",
        "Angle at which the upper stop begins.",
        default=1e4,
        bounds=(-1e4, 1e4),
        source="definition: out of reach, no stop",
    )
    stiffness = Parameter(
        "N m/rad",
        "k: stiffness of the stops.",
        default=500,
        bounds=(0, 1e6),
        source="sconemodels: models H1922 and H0918",
    )
    stop_damping = Parameter(
        "s/rad", "k_w: damping of the stops.", default=0, bounds=(0, 1e3), source="definition: an elastic stop"
    )
    damping = Parameter(
        "N m s/rad", "Viscous damping at all angles.", default=0, bounds=(0, 1000), source="definition: an ideal hinge"
    )
    moment = Input("N m", "Moment in the direction of increasing angle.", sums=True)
    angle = Output(
        "rad",
        "Angle from the posture in which the two frames are aligned.",
        usual=("lower - 0.2", "upper + 0.2"),
        possible=("lower - pi / 2", "upper + pi / 2"),
    )
    angular_velocity = Output("rad/s", "Rate of the angle.")
    spring = Output("N m", "Moment of the stops without velocity; positive at the lower one.")
    drag = Output("N m s/rad", "Damping of the stops.")
    stop_moment = Output("N m", "Moment of the stops.")
    stop_energy = Output("J", "Elastic energy in the stops, k d^2 / 2.", usual=(0, 5), possible=(0, 1000))
    total = Output("N m", "Sum of the moments of connected parts and springs.")

    stops = Curve(
        "stop_moment",
        "angle",
        (-1, 1),
        "Moment of stops at -30 and 30 deg.",
        at={"lower": -30, "upper": 30, "stop_damping": 0.2},
        each=("angular_velocity", (-3, 0, 3)),
    )

    @staticmethod
    def output(p, u, x, y):
        below, above = max(0.0, p.lower - y.angle), max(0.0, y.angle - p.upper)
        y.spring = p.stiffness * (below - above)
        y.stop_energy = 0.5 * p.stiffness * (below**2 + above**2)
        # On the way out, damping takes at most the moment of the spring, so that a stop never pulls into the limit.
        leaving = y.angular_velocity * (below - above) > 0
        damped = p.stiffness * (below + above) * p.stop_damping
        y.drag = damped
        if leaving:
            y.drag = min(damped, abs(y.spring) / abs(y.angular_velocity))
        y.stop_moment = y.spring - y.drag * y.angular_velocity
        y.total = u.moment + y.spring

    @staticmethod
    def build(p, mj):
        if p.axis_forward == 0 and p.axis_left == 0 and p.axis_up == 0:
            raise Refused("its axis has no length; say where it points by axis_forward, axis_left and axis_up")
        if not p.lower <= p.upper:
            low, high = math.degrees(p.lower), math.degrees(p.upper)
            raise Refused(f"lower {low:g} deg is above upper {high:g} deg; exchange them")
        within = (p.lower, p.upper) if 0 < p.upper - p.lower < 10 else None
        joint = mj.hinge(axis=(p.axis_forward, p.axis_left, p.axis_up), damping=p.damping, limits=within)
        mj.read("angle", joint, "qpos")
        mj.read("angular_velocity", joint, "qvel")
        mj.apply("total", joint, "qfrc_applied")
        if p.stop_damping > 0:
            mj.apply("drag", mj.motor(joint, "brake", gain=(0, -1)), "ctrl")
