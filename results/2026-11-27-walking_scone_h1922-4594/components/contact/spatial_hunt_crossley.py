import math

from gaitsim.component import Attachment, Component, Curve, Input, Output, Parameter, Part, State, StepLimit


class SpatialHuntCrossley(Component):
    """Contact of a sphere with the ground in space: Hunt-Crossley normal force, and friction in both directions.

    F = (k d)^1.5 (1 + 1.5 c d'), never negative, as in the public models of SCONE; the radius of the sphere is part of
    k: two equal materials of k = (4/3 s sqrt(R))^(2/3) make k / 2 (OpenSim's stiffness s). Friction is against the
    slip: F (min(v/v_t, 1) (mu_d + 2 (mu_s - mu_d) / (1 + (v/v_t)^2)) + mu_v v), of the speed v of the lowest point.

    The velocity terms are solved implicitly, for the velocity at the end of the step. The output forces are those of
    the previous step.
    """

    frame = Attachment("The center of the sphere.")
    radius = Parameter(
        "m", "Radius of the sphere.", default=0.03, bounds=(1e-3, 1), source="sconemodels: model H1922, heel"
    )
    stiffness = Parameter(
        "N^(2/3)/m",
        "k of sphere and ground together.",
        default=5503.2,
        bounds=(1, 1e7),
        source="sconemodels: model H1922, half of the 11006.4 of either material",
    )
    dissipation = Parameter("s/m", "c: dissipation.", default=1, bounds=(0, 100), source="sconemodels: model H1922")
    static_friction = Parameter(
        "1", "mu_s: static friction.", default=0.9, bounds=(0, 10), source="sconemodels: model H1922"
    )
    dynamic_friction = Parameter(
        "1", "mu_d: dynamic friction.", default=0.6, bounds=(0, 10), source="sconemodels: model H1922"
    )
    viscous_friction = Parameter(
        "s/m", "mu_v: viscous friction.", default=0, bounds=(0, 10), source="sconemodels: model H1922 has none"
    )
    transition_velocity = Parameter(
        "m/s",
        "v_t: slip velocity at which friction is largest.",
        default=0.15,
        bounds=(1e-4, 10),
        source="sconemodels: simulations of H1922 and H0918",
    )
    terrain = Part(
        "terrain",
        "The ground.",
        default="terrain/flat",
        reads=(("ground_height", "height"), ("gradient", "gradient"), ("side_gradient", "side_gradient")),
        sends=(("position", "position"), ("side_position", "side_position")),
    )
    ground_height = Input("m", "Height of the ground below the sphere.", default=0)
    gradient = Input("1", "How much the ground rises there, forwards.", default=0)
    side_gradient = Input("1", "How much the ground rises there, to the left.", default=0)
    stepped = State(levels=("no", "yes"), doc="No in the first step, yes afterwards.")
    spring_before = State("N", "Normal force without velocity, one step ago.")
    drag_before = State("N s/m", "Damping along the ground, one step ago.")
    tilt_before = State("N", "Tilt of the normal force, forwards, one step ago.")
    side_tilt_before = State("N", "Tilt of the normal force, to the left, one step ago.")
    position = Output("m", "Forward position of the sphere's center along the ground.")
    side_position = Output("m", "Position of the sphere's center along the ground, to the left.")
    center_height = Output("m", "Height of the sphere's center.")
    velocity = Output("m/s", "Upward velocity of the sphere's center.")
    slip_velocity = Output("m/s", "Velocity of the sphere's lowest point along the ground, forwards.")
    side_slip_velocity = Output("m/s", "Velocity of the sphere's lowest point along the ground, to the left.")
    height = Output(
        "m", "Height of the sphere's lowest point above the ground.", usual=(-0.03, 100), possible=(-0.3, 1e4)
    )
    weight = Output("N", "Weight of the whole model.")
    spring = Output("N", "Normal force without velocity.")
    drag = Output("N s/m", "Damping along the ground.")
    tilt = Output("N", "Forward part of the normal force where the ground rises.")
    side_tilt = Output("N", "Part of the normal force to the left where the ground rises.")
    force = Output("N", "Force of the ground on the sphere, along the ground's normal; one step old.")
    friction_force = Output("N", "Force of the ground on the sphere along the ground, forwards; one step old.")
    side_force = Output("N", "Force of the ground on the sphere along the ground, to the left; one step old.")
    load = Output("1", "Force in body weights; one step old.", usual=(0, 3), possible=(0, 20))
    in_contact = Output("1", "1 while the sphere is below the ground's surface, else 0.")
    energy = Output("J", "Elastic energy in the ground, 2/5 d F at rest.")

    largest_step = StepLimit(
        "ms",
        "80 kg on a foot of 1.25 kg landing on its heel at 0.5 m/s: peak force within 1 %, energy lost within 0.1 % "
        "of those at 0.02 ms. With integrator: euler the limit is 0.1 ms.",
        1,
    )

    pressing = Curve(
        "force",
        "center_height",
        (0.01, 0.035),
        "Normal force over the height of the center.",
        each=("velocity", (-0.3, 0, 0.3)),
    )
    moving = Curve("force", "velocity", (-1, 1), "Normal force over velocity.", each=("center_height", (0.025, 0.02)))
    slipping = Curve(
        "drag", "slip_velocity", (-0.5, 0.5), "Friction over slip velocity, per velocity.", at={"center_height": 0.02}
    )

    @staticmethod
    def output(p, u, x, y):
        longer = math.sqrt(1 + u.gradient**2 + u.side_gradient**2)
        y.height = (y.center_height - u.ground_height) / longer - p.radius
        y.in_contact = 1.0 if y.height < 0 else 0.0
        depth = max(0.0, -y.height)
        pressing = (p.stiffness * depth) ** 1.5
        y.energy = 0.4 * pressing * depth
        y.spring = pressing / longer
        spring = x.spring_before if x.stepped == 1 else y.spring
        share = max(0.0, 1 - 1.5 * p.dissipation * y.velocity)
        y.force = spring * share
        y.tilt, y.side_tilt = -u.gradient * y.spring * share, -u.side_gradient * y.spring * share
        y.friction_force = x.tilt_before - x.drag_before * y.slip_velocity
        y.side_force = x.side_tilt_before - x.drag_before * y.side_slip_velocity
        y.load = y.force / y.weight if y.weight > 0 else 0.0
        speed = math.sqrt(y.slip_velocity**2 + y.side_slip_velocity**2)
        peak = 2 * (p.static_friction - p.dynamic_friction) / (1 + (speed / p.transition_velocity) ** 2)
        y.drag = y.force * ((p.dynamic_friction + peak) / max(speed, p.transition_velocity) + p.viscous_friction)

    @staticmethod
    def update(p, u, x, y, dt):
        x.stepped, x.spring_before, x.drag_before = 1, y.spring, y.drag
        x.tilt_before, x.side_tilt_before = y.tilt, y.side_tilt

    @staticmethod
    def build(p, mj):
        center = mj.attached("frame")
        below = (0, 0, -p.radius)
        rate = 1.5 * p.dissipation
        normal = mj.push(center, axis=(0, 0, 1), suffix="normal", surface="terrain", gain=(1, -rate), limits=(0, 1e9))
        brake = mj.push(center, axis=(1, 0, 0), suffix="brake", surface="terrain", reach=below, gain=(0, -1))
        side = mj.push(center, axis=(0, 1, 0), suffix="side_brake", surface="terrain", reach=below, gain=(0, -1))
        place = mj.position_of(center, surface="terrain")
        mj.read("position", place, "sensordata", 0)
        mj.read("side_position", place, "sensordata", 1)
        mj.read("center_height", normal, "actuator_length")
        mj.read("velocity", normal, "actuator_velocity")
        mj.read("slip_velocity", brake, "actuator_velocity")
        mj.read("side_slip_velocity", side, "actuator_velocity")
        mj.touches(center, p.radius)
        mj.read_weight("weight")
        mj.apply("spring", normal, "ctrl")
        mj.apply("drag", brake, "ctrl")
        mj.apply("drag", side, "ctrl")
        mj.tilt(center, surface="terrain", forward="tilt", left="side_tilt")
        mj.draw_force(center, up="force", forward="friction_force", left="side_force", surface="terrain")
