from gaitsim.component import Attachment, Component, Curve, Input, Option, Output, Parameter, Refused, State, StepLimit


class Geyer2010(Component):
    """A hinge with the dissipative soft stops of Geyer & Herr (2010) and the paper's convention of angles.

    At a depth d > 0 beyond a stop, the moment is c d (1 + d' / w), directed out of the stop and never into it.
    The paper's angles: ankle, neutral 90 deg, grows backwards (plantarflexion is positive); knee, neutral
    180 deg, grows forwards (extension is positive); hip, neutral 180 deg, grows backwards (extension is
    positive). The paper's stops: ankle 70 and 130 deg, knee 175 deg (upper), hip 230 deg (upper).

    With w = 1 deg/s, damping dominates: 980 d N m s/rad. With explicit steps of 1 ms, a free foot would leave the
    stop 15 times as fast as it came, from a depth of 5 deg. The moment is therefore solved implicitly, for the
    velocity at the end of the step; `stop_moment` is that of the previous step.
    """

    parent = Attachment("The frame that holds the hinge.")
    child = Attachment("The frame that turns.")
    grows = Option(
        "Direction in which a hanging child turns as the angle increases.", choices=("backwards", "forwards")
    )
    neutral = Parameter(
        "deg",
        "Angle at which the two frames are aligned.",
        default=0,
        bounds=(-360, 360),
        source="definition: a choice",
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
    stiffness = Parameter("N m/deg", "c: stiffness of a stop.", default=0.3, bounds=(0, 1e4), source="geyer2010")
    release_velocity = Parameter(
        "deg/s",
        "w: angular velocity out of a stop at which its moment vanishes.",
        default=1,
        bounds=(1e-3, 1e6),
        source="geyer2010",
    )
    damping = Parameter(
        "N m s/rad", "Viscous damping at all angles.", default=0, bounds=(0, 1000), source="definition: an ideal hinge"
    )
    moment = Input("N m", "Moment in the direction of increasing angle.", sums=True)
    below = State("N m", "Elastic moment of the lower stop one step ago.")
    above = State("N m", "Elastic moment of the upper stop one step ago.")
    stepped = State(levels=("no", "yes"), doc="No in the first step, yes afterwards.")
    angle = Output(
        "rad",
        "Angle.",
        usual=("lower - 0.1", "upper + 0.1"),
        possible=("lower - pi / 2", "upper + pi / 2"),
    )
    angular_velocity = Output("rad/s", "Rate of the angle.")
    lower_spring = Output("N m", "Elastic moment of the lower stop, c d.")
    upper_spring = Output("N m", "Elastic moment of the upper stop, c d.")
    stop_moment = Output("N m", "Moment of the stops; positive at the lower one; one step old.")
    stop_energy = Output("J", "Elastic energy in the stops, c d^2 / 2.", usual=(0, 5), possible=(0, 1000))

    largest_step = StepLimit(
        "ms",
        "The paper's foot, 1.25 kg, thrown into its ankle's stop at 10 rad/s: it stops within 0.3 deg of where it "
        "does at 0.01 ms, at 1 ms within 0.15 deg, and leaves no faster than 1 deg/s. With integrator: euler it is "
        "thrown back from 1 deg on, at any step above 0.1 ms.",
        2,
    )

    stops = Curve(
        "stop_moment",
        "angle",
        (0.9, 2.6),
        "Moment of the ankle's stops at 70 and 130 deg.",
        at={"lower": 70, "upper": 130},
        each=("angular_velocity", (-0.01, 0, 0.01)),
    )

    @staticmethod
    def output(p, u, x, y):
        below, above = max(0.0, p.lower - y.angle), max(0.0, y.angle - p.upper)
        y.lower_spring, y.upper_spring = p.stiffness * below, p.stiffness * above
        y.stop_energy = 0.5 * p.stiffness * (below**2 + above**2)
        lower = x.below if x.stepped == 1 else y.lower_spring
        upper = x.above if x.stepped == 1 else y.upper_spring
        growth = y.angular_velocity / p.release_velocity
        y.stop_moment = lower * max(0.0, 1 - growth) - upper * max(0.0, 1 + growth)

    @staticmethod
    def update(p, u, x, y, dt):
        x.below, x.above, x.stepped = y.lower_spring, y.upper_spring, 1

    @staticmethod
    def build(p, mj):
        if not p.lower < p.upper:
            raise Refused(f"lower {p.lower:g} rad is not below upper {p.upper:g} rad; change one")
        within = (p.lower, p.upper) if p.upper - p.lower < 10 else None
        joint = mj.hinge(
            axis=(0, 1 if p.grows == "backwards" else -1, 0), damping=p.damping, limits=within, neutral=p.neutral
        )
        rate = 1 / p.release_velocity
        lower = mj.motor(joint, "lower", gain=(1, -rate), limits=(0, 1e9))
        upper = mj.motor(joint, "upper", gain=(-1, -rate), limits=(-1e9, 0))
        mj.read("angle", joint, "qpos")
        mj.read("angular_velocity", joint, "qvel")
        mj.apply("moment", joint, "qfrc_applied")
        mj.apply("lower_spring", lower, "ctrl")
        mj.apply("upper_spring", upper, "ctrl")
