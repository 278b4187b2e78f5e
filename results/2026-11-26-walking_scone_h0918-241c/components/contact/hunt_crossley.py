import math

from gaitsim.component import Attachment, Component, Curve, Input, Output, Parameter, Part, State, StepLimit


class HuntCrossley(Component):
    """A sphere of Hertz with the dissipation of Hunt & Crossley against the ground, and friction without stiction.

    F = 4/3 s sqrt(R) (d/2)^1.5 (1 + 1.5 c d'), never pulling, for two equal materials of stiffness s.
    Friction: F (min(v/v_t, 1) (mu_d + 2 (mu_s - mu_d) / (1 + (v/v_t)^2)) + mu_v v). The smooth law blends contact in
    and out with hyperbolic tangents; it has a small force above the ground too.

    Its velocity terms are solved for the velocity at the end of the step. The forces that go out are those of this
    instant. A velocity of semi-implicit steps is that of half a step ago, so the normal force takes it half a step
    further. What really acted goes out as well, for the balance of energy.
    """

    frame = Attachment("The center of the sphere.")
    smooth = Parameter(
        "1",
        "1 for the smooth law, 0 for the plain one.",
        default=0,
        bounds=(0, 1),
        source="definition: the law as Hunt & Crossley have it",
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
    dissipation = Parameter("s/m", "c.", default=1, bounds=(0, 100), source="geijtenbeek2019: model H0914")
    static_friction = Parameter("1", "mu_s.", default=0.9, bounds=(0, 10), source="geijtenbeek2019: model H0914")
    dynamic_friction = Parameter("1", "mu_d.", default=0.8, bounds=(0, 10), source="geijtenbeek2019: model H0914")
    viscous_friction = Parameter("s/m", "mu_v.", default=0.6, bounds=(0, 10), source="geijtenbeek2019: model H0914")
    transition_velocity = Parameter(
        "m/s",
        "v_t: slip at which friction is highest.",
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
        reads=(("ground_height", "height"),),
        sends=(("position", "position"),),
    )
    ground_height = Input("m", "Height of the ground where the sphere is.", default=0)
    stepped = State(levels=("no", "yes"), doc="Whether there is a step before.")
    spring_before = State("N", "Normal force without velocity, one step ago.")
    drag_before = State("N s/m", "Damping along the ground, one step ago.")
    velocity_before = State("m/s", "Velocity of the center, one step ago.")
    position = Output("m", "Where the sphere's center is along the ground.")
    center_height = Output("m", "Height of the sphere's center.")
    velocity = Output("m/s", "Its rate.")
    slip_velocity = Output("m/s", "Forward velocity of the sphere's lowest point.")
    height = Output(
        "m", "Height of the sphere's lowest point above the ground.", usual=(-0.03, 100), possible=(-0.3, 1e4)
    )
    weight = Output("N", "Weight of all that moves.")
    spring = Output("N", "Normal force without velocity.")
    drag = Output("N s/m", "Damping along the ground.")
    force = Output("N", "Force of the ground on the sphere, along the ground's normal.")
    friction_force = Output("N", "Force of the ground on the sphere, forwards along the ground.")
    applied_force = Output("N", "Normal force that acted in the step before.")
    applied_friction_force = Output("N", "Friction force that acted in the step before.")
    load = Output("1", "Force in weights of all that moves.", usual=(0, 3), possible=(0, 20))
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
        y.height = y.center_height - p.radius - u.ground_height
        y.in_contact = 1.0 if y.height < 0 else 0.0
        depth = max(0.0, -y.height)
        blend = 1.0
        if p.smooth > 0.5:
            depth = math.sqrt(y.height**2 + p.contact_width**2)
            blend = 0.5 + 0.5 * math.tanh(-p.contact_blend * y.height)
            if p.dissipation > 0:
                going_in = 2 / (3 * p.dissipation) - y.velocity
                blend = blend * (0.5 + 0.5 * math.tanh(p.release_blend * going_in))
        y.spring = 4 / 3 * p.stiffness * math.sqrt(p.radius) * (depth / 2) ** 1.5 * blend
        y.energy = 0.4 * y.spring * depth
        rate = 1.5 * p.dissipation
        change = y.velocity - x.velocity_before if x.stepped == 1 else 0.0
        y.force = y.spring * max(0.0, 1 - rate * (y.velocity + 0.5 * change))
        y.load = y.force / y.weight if y.weight > 0 else 0.0
        speed = abs(y.slip_velocity)
        peak = 2 * (p.static_friction - p.dynamic_friction) / (1 + (speed / p.transition_velocity) ** 2)
        y.drag = y.force * ((p.dynamic_friction + peak) / max(speed, p.transition_velocity) + p.viscous_friction)
        y.friction_force = -y.drag * y.slip_velocity
        y.applied_force = x.spring_before * max(0.0, 1 - rate * y.velocity)
        y.applied_friction_force = -x.drag_before * y.slip_velocity

    @staticmethod
    def update(p, u, x, y, dt):
        x.stepped = 1
        x.spring_before, x.drag_before, x.velocity_before = y.spring, y.drag, y.velocity

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
        mj.draw_force(center, up="force", forward="friction_force", surface="terrain")
