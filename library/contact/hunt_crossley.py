import math

from gaitsim.component import Attachment, Component, Curve, Input, Output, Parameter, Part, State, StepLimit


class HuntCrossley(Component):
    """Contact of a sphere with the ground: Hertz stiffness, Hunt-Crossley dissipation, friction without stiction.

    F = 4/3 s sqrt(R) (d/2)^1.5 (1 + 1.5 c d'), never negative, for two equal materials of stiffness s.
    Friction: F (min(v/v_t, 1) (mu_d + 2 (mu_s - mu_d) / (1 + (v/v_t)^2)) + mu_v v). The smooth law begins and ends
    contact with hyperbolic tangents; it has a small force above the ground too.

    The velocity terms are solved implicitly, for the velocity at the end of the step. The output forces are those of
    the present instant. Semi-implicit steps give the velocity of half a step ago; the normal force extrapolates it by
    half a step. The forces that acted in the previous step are outputs too, for the energy balance.
    """

    frame = Attachment("The center of the sphere.")
    smooth = Parameter(
        "1",
        "1 for the smooth law, 0 for the law of Hunt & Crossley.",
        default=0,
        bounds=(0, 1),
        source="definition: the original law",
        whole=True,
    )
    radius = Parameter(
        "m",
        "Radius of the sphere.",
        default=0.03,
        bounds=(1e-3, 1),
        source="geijtenbeek2019: model H0914, heel and toe",
    )
    stiffness = Parameter(
        "Pa",
        "s: stiffness of each of the two materials.",
        default=2e6,
        bounds=(1, 1e12),
        source="geijtenbeek2019: H0914",
    )
    dissipation = Parameter("s/m", "c: dissipation.", default=1, bounds=(0, 100), source="geijtenbeek2019: model H0914")
    static_friction = Parameter(
        "1", "mu_s: static friction.", default=0.9, bounds=(0, 10), source="geijtenbeek2019: model H0914"
    )
    dynamic_friction = Parameter(
        "1", "mu_d: dynamic friction.", default=0.8, bounds=(0, 10), source="geijtenbeek2019: model H0914"
    )
    viscous_friction = Parameter(
        "s/m", "mu_v: viscous friction.", default=0.6, bounds=(0, 10), source="geijtenbeek2019: model H0914"
    )
    transition_velocity = Parameter(
        "m/s",
        "v_t: slip velocity at which friction is largest.",
        default=0.1,
        bounds=(1e-4, 10),
        source="geijtenbeek2019: model H0914",
    )
    contact_width = Parameter(
        "m",
        "Smooth law: depth below which the force is rounded.",
        default=0.0031622776601683794,
        bounds=(1e-9, 1),
        source="seth2018: sqrt(1e-5 m^2)",
    )
    contact_blend = Parameter(
        "1/m",
        "Smooth law: steepness over depth.",
        default=300,
        bounds=(1, 1e6),
        source="seth2018: bd of the smooth force",
    )
    release_blend = Parameter(
        "s/m",
        "Smooth law: steepness over velocity.",
        default=50,
        bounds=(1, 1e6),
        source="seth2018: bv of the smooth force",
    )
    terrain = Part(
        "terrain",
        "The ground.",
        default="terrain/flat",
        reads=(("ground_height", "height"), ("gradient", "gradient")),
        sends=(("position", "position"),),
    )
    ground_height = Input("m", "Height of the ground below the sphere.", default=0)
    gradient = Input("1", "How much the ground rises there, forwards.", default=0)
    stepped = State(levels=("no", "yes"), doc="No in the first step, yes afterwards.")
    spring_before = State("N", "Normal force without velocity, one step ago.")
    drag_before = State("N s/m", "Damping along the ground, one step ago.")
    tilt_before = State("N", "Tilt of the normal force, forwards, one step ago.")
    velocity_before = State("m/s", "Velocity of the center, one step ago.")
    position = Output("m", "Position of the sphere's center along the ground.")
    center_height = Output("m", "Height of the sphere's center.")
    velocity = Output("m/s", "Upward velocity of the sphere's center.")
    slip_velocity = Output("m/s", "Forward velocity of the sphere's lowest point.")
    height = Output(
        "m", "Height of the sphere's lowest point above the ground.", usual=(-0.03, 100), possible=(-0.3, 1e4)
    )
    weight = Output("N", "Weight of the whole model.")
    spring = Output("N", "Normal force without velocity.")
    drag = Output("N s/m", "Damping along the ground.")
    tilt = Output("N", "Forward part of the normal force where the ground rises.")
    force = Output("N", "Force of the ground on the sphere, along the ground's normal.")
    friction_force = Output("N", "Force of the ground on the sphere, forwards along the ground.")
    applied_force = Output("N", "Normal force that acted in the previous step.")
    applied_friction_force = Output("N", "Friction force that acted in the previous step.")
    load = Output("1", "Force in body weights.", usual=(0, 3), possible=(0, 20))
    in_contact = Output("1", "1 while the sphere is below the ground's surface, else 0.")
    energy = Output("J", "Elastic energy in the ground, 2/5 d F at rest.")

    largest_step = StepLimit(
        "ms",
        "80 kg on a foot of 1.25 kg landing on its heel at 0.5 m/s: peak force within 1 %, energy lost within 0.1 % "
        "of those at 0.02 ms. With integrator: euler the limit is 0.1 ms.",
        2,
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
        longer = math.sqrt(1 + u.gradient**2)
        y.height = (y.center_height - u.ground_height) / longer - p.radius
        y.in_contact = 1.0 if y.height < 0 else 0.0
        depth = max(0.0, -y.height)
        blend = 1.0
        if p.smooth > 0.5:
            depth = math.sqrt(y.height**2 + p.contact_width**2)
            blend = 0.5 + 0.5 * math.tanh(-p.contact_blend * y.height)
            if p.dissipation > 0:
                going_in = 2 / (3 * p.dissipation) - y.velocity
                blend = blend * (0.5 + 0.5 * math.tanh(p.release_blend * going_in))
        pressing = 4 / 3 * p.stiffness * math.sqrt(p.radius) * (depth / 2) ** 1.5 * blend
        y.energy = 0.4 * pressing * depth
        y.spring = pressing / longer
        rate = 1.5 * p.dissipation
        change = y.velocity - x.velocity_before if x.stepped == 1 else 0.0
        y.force = y.spring * max(0.0, 1 - rate * (y.velocity + 0.5 * change))
        y.tilt = -u.gradient * y.force
        y.load = y.force / y.weight if y.weight > 0 else 0.0
        speed = abs(y.slip_velocity)
        peak = 2 * (p.static_friction - p.dynamic_friction) / (1 + (speed / p.transition_velocity) ** 2)
        y.drag = y.force * ((p.dynamic_friction + peak) / max(speed, p.transition_velocity) + p.viscous_friction)
        y.friction_force = y.tilt - y.drag * y.slip_velocity
        y.applied_force = x.spring_before * max(0.0, 1 - rate * y.velocity)
        y.applied_friction_force = x.tilt_before - x.drag_before * y.slip_velocity

    @staticmethod
    def update(p, u, x, y, dt):
        x.stepped = 1
        x.spring_before, x.drag_before, x.velocity_before = y.spring, y.drag, y.velocity
        x.tilt_before = y.tilt

    @staticmethod
    def build(p, mj):
        center = mj.attached("frame")
        below = (0, 0, -p.radius)
        rate = 1.5 * p.dissipation
        normal = mj.push(center, axis=(0, 0, 1), suffix="normal", surface="terrain", gain=(1, -rate), limits=(0, 1e9))
        brake = mj.push(center, axis=(1, 0, 0), suffix="brake", surface="terrain", reach=below, gain=(0, -1))
        place = mj.position_of(center, surface="terrain")
        mj.read("position", place, "sensordata", 0)
        mj.read("center_height", normal, "actuator_length")
        mj.read("velocity", normal, "actuator_velocity")
        mj.read("slip_velocity", brake, "actuator_velocity")
        mj.touches(center, p.radius)
        mj.read_weight("weight")
        mj.apply("spring", normal, "ctrl")
        mj.apply("drag", brake, "ctrl")
        mj.tilt(center, surface="terrain", forward="tilt")
        mj.draw_force(center, up="force", forward="friction_force", surface="terrain")
