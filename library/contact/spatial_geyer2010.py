import math

from gaitsim.component import Attachment, Component, Curve, Input, Output, Parameter, Part, State, StepLimit


class SpatialGeyer2010(Component):
    """The ground of Geyer & Herr (2010) under one point in space, with stiction and sliding in both directions.

    Normal force: F = k d (1 + d' / v), never negative, with k = weight / 1 cm. Stiction: F = -k_x (r + |r| w / v_x),
    with k_x = weight / 10 cm; r leads from where the point touched down or came to rest to where it is, and w is its
    velocity. Along a line this is the law of contact/geyer2010. Beyond 0.9 of the normal force the point slides, with a
    friction of 0.8 of the normal force against its velocity, until it is slower than 1 cm/s.

    The velocity terms are solved implicitly, for the velocity at the end of the step. The output forces are those of
    the previous step.
    """

    frame = Attachment("The point that touches the ground.")
    sinking = Parameter(
        "m",
        "Depth of one point under the weight of the whole model: k = weight / depth.",
        default=0.01,
        bounds=(1e-5, 1),
        source="geyer2010",
    )
    release_velocity = Parameter(
        "m/s",
        "v: upward velocity at which the normal force vanishes.",
        default=0.03,
        bounds=(1e-4, 100),
        source="geyer2010",
    )
    shear = Parameter(
        "m",
        "Shift of one point under a horizontal force of one weight: k_x = weight / shift.",
        default=0.1,
        bounds=(1e-5, 10),
        source="geyer2010",
    )
    shear_velocity = Parameter(
        "m/s",
        "v_x: sliding velocity at which the spring force doubles or vanishes.",
        default=0.03,
        bounds=(1e-4, 100),
        source="geyer2010",
    )
    static_friction = Parameter(
        "1", "Coefficient of static friction: a point slips beyond it.", default=0.9, bounds=(0, 10), source="geyer2010"
    )
    sliding_friction = Parameter(
        "1", "Coefficient of sliding friction.", default=0.8, bounds=(0, 10), source="geyer2010"
    )
    sticking_velocity = Parameter(
        "m/s", "Velocity below which a sliding point sticks again.", default=0.01, bounds=(1e-5, 10), source="geyer2010"
    )
    terrain = Part(
        "terrain",
        "The ground.",
        default="terrain/flat",
        reads=(("ground_height", "height"), ("gradient", "gradient"), ("side_gradient", "side_gradient")),
        sends=(("position", "position"), ("side_position", "side_position")),
    )
    ground_height = Input("m", "Height of the ground below the point.", default=0)
    gradient = Input("1", "How much the ground rises there, forwards.", default=0)
    side_gradient = Input("1", "How much the ground rises there, to the left.", default=0)
    touching = State(levels=("no", "yes"), doc="Whether the point was below the surface one step ago.")
    mode = State(levels=("sliding", "sticking"), doc="Whether the point was sliding or sticking one step ago.")
    held_at = State("m", "Position at which the point sticks.")
    held_aside = State("m", "That position, to the left.")
    stepped = State(levels=("no", "yes"), doc="No in the first step, yes afterwards.")
    spring_before = State("N", "Normal force without velocity, one step ago.")
    shear_before = State("N", "Shear force forwards without velocity, one step ago.")
    side_shear_before = State("N", "Shear force to the left without velocity, one step ago.")
    drag_before = State("N s/m", "Damping along the ground, one step ago.")
    tilt_before = State("N", "Tilt of the normal force, forwards, one step ago.")
    side_tilt_before = State("N", "Tilt of the normal force, to the left, one step ago.")
    position = Output("m", "Forward position of the point along the ground.")
    side_position = Output("m", "Position of the point along the ground, to the left.")
    slip_velocity = Output("m/s", "Velocity of the point along the ground, forwards.")
    side_slip_velocity = Output("m/s", "Velocity of the point along the ground, to the left.")
    place_height = Output("m", "Height of the point, from the same zero as heights of the ground.")
    height = Output("m", "Height of the point above the ground.", usual=(-0.03, 100), possible=(-0.3, 1e4))
    velocity = Output("m/s", "Upward velocity of the point.")
    weight = Output("N", "Weight of the whole model.")
    force = Output("N", "Force of the ground on the point, along the ground's normal; one step old.")
    friction_force = Output("N", "Force of the ground on the point along the ground, forwards; one step old.")
    side_force = Output("N", "Force of the ground on the point along the ground, to the left; one step old.")
    load = Output("1", "Force in body weights; one step old.", usual=(0, 3), possible=(0, 20))
    in_contact = Output("1", "1 while the point is below the ground's surface, else 0.")
    sticks = Output("1", "1 while the point sticks, else 0.")
    anchor = Output("m", "Position at which the point sticks.")
    side_anchor = Output("m", "That position, to the left.")
    spring = Output("N", "Normal force without velocity.")
    shear_spring = Output("N", "Shear force forwards without velocity.")
    side_shear_spring = Output("N", "Shear force to the left without velocity.")
    drag = Output("N s/m", "Damping along the ground.")
    tilt = Output("N", "Forward part of the normal force where the ground rises.")
    side_tilt = Output("N", "Part of the normal force to the left where the ground rises.")
    energy = Output("J", "Elastic energy in the ground, k d^2 / 2 + k_x r^2 / 2.")

    largest_step = StepLimit(
        "ms",
        "80 kg on the 1.25 kg foot of the paper landing on its heel at 0.5 m/s: peak force within 4 %, energy lost "
        "within 0.1 % of those at 0.02 ms. With integrator: euler the limit is 0.02 ms.",
        1,
    )

    pressing = Curve(
        "force",
        "place_height",
        (-0.02, 0.005),
        "Normal force over height, 80 kg.",
        at={"weight": 785},
        each=("velocity", (-0.03, 0, 0.015)),
    )
    moving = Curve(
        "force",
        "velocity",
        (-0.1, 0.06),
        "Normal force over velocity, 80 kg.",
        at={"weight": 785},
        each=("place_height", (-0.005, -0.01)),
    )
    sticking = Curve(
        "shear_spring",
        "position",
        (-0.08, 0.08),
        "Stiction at rest over the shift from where it touched down, 80 kg.",
        at={"weight": 785, "place_height": -0.01, "touching": 1, "mode": 1, "held_at": 0},
    )

    @staticmethod
    def output(p, u, x, y):
        longer = math.sqrt(1 + u.gradient**2 + u.side_gradient**2)
        y.height = (y.place_height - u.ground_height) / longer
        depth = max(0.0, -y.height)
        y.in_contact = 1.0 if depth > 0 else 0.0
        pressing = y.weight / p.sinking * depth
        y.spring = pressing / longer
        spring = x.spring_before if x.stepped == 1 else y.spring
        share = max(0.0, 1 - y.velocity / p.release_velocity)
        y.force = spring * share
        y.tilt, y.side_tilt = -u.gradient * y.spring * share, -u.side_gradient * y.spring * share
        rubbing = x.shear_before - x.drag_before * y.slip_velocity
        side_rubbing = x.side_shear_before - x.drag_before * y.side_slip_velocity
        y.friction_force, y.side_force = x.tilt_before + rubbing, x.side_tilt_before + side_rubbing
        y.load = y.force / y.weight if y.weight > 0 else 0.0

        slip = math.sqrt(y.slip_velocity**2 + y.side_slip_velocity**2)
        y.sticks, y.anchor, y.side_anchor = 1.0, y.position, y.side_position
        if x.touching == 1 and x.mode == 1:
            y.anchor, y.side_anchor = x.held_at, x.held_aside
            size = math.sqrt(rubbing**2 + side_rubbing**2)
            y.sticks = 1.0 if size <= p.static_friction * y.force else 0.0
        elif x.touching == 1:
            y.sticks = 1.0 if slip < p.sticking_velocity else 0.0

        stiffness = y.weight / p.shear
        shift = y.position - y.anchor if y.sticks == 1 else 0.0
        side_shift = y.side_position - y.side_anchor if y.sticks == 1 else 0.0
        distance = math.sqrt(shift**2 + side_shift**2)
        y.shear_spring, y.side_shear_spring, y.drag = 0.0, 0.0, 0.0
        if y.in_contact == 1 and y.sticks == 1:
            y.shear_spring, y.side_shear_spring = -stiffness * shift, -stiffness * side_shift
            y.drag = stiffness * distance / p.shear_velocity
        elif y.in_contact == 1:
            # Coulomb friction as an implicit damper: it can stop the point at the end of the step, but not reverse it.
            y.drag = p.sliding_friction * y.force / max(slip, p.sticking_velocity)
        y.energy = 0.5 * (pressing * depth + stiffness * distance**2 * y.in_contact)

    @staticmethod
    def update(p, u, x, y, dt):
        x.stepped = 1
        x.touching, x.mode, x.held_at, x.held_aside = y.in_contact, y.sticks, y.anchor, y.side_anchor
        x.spring_before, x.drag_before = y.spring, y.drag
        x.shear_before, x.side_shear_before = y.shear_spring, y.side_shear_spring
        x.tilt_before, x.side_tilt_before = y.tilt, y.side_tilt

    @staticmethod
    def build(p, mj):
        point = mj.attached("frame")
        normal = mj.push(
            point,
            axis=(0, 0, 1),
            suffix="normal",
            surface="terrain",
            gain=(1, -1 / p.release_velocity),
            limits=(0, 1e9),
        )
        along = mj.push(point, axis=(1, 0, 0), suffix="along", surface="terrain")
        aside = mj.push(point, axis=(0, 1, 0), suffix="aside", surface="terrain")
        brake = mj.push(point, axis=(1, 0, 0), suffix="brake", surface="terrain", gain=(0, -1))
        side_brake = mj.push(point, axis=(0, 1, 0), suffix="side_brake", surface="terrain", gain=(0, -1))
        mj.read("position", along, "actuator_length")
        mj.read("side_position", aside, "actuator_length")
        mj.read("slip_velocity", along, "actuator_velocity")
        mj.read("side_slip_velocity", aside, "actuator_velocity")
        mj.read("place_height", normal, "actuator_length")
        mj.read("velocity", normal, "actuator_velocity")
        mj.touches(point)
        mj.read_weight("weight")
        mj.apply("spring", normal, "ctrl")
        mj.apply("shear_spring", along, "ctrl")
        mj.apply("side_shear_spring", aside, "ctrl")
        mj.apply("drag", brake, "ctrl")
        mj.apply("drag", side_brake, "ctrl")
        mj.tilt(point, surface="terrain", forward="tilt", left="side_tilt")
        mj.draw_force(point, up="force", forward="friction_force", left="side_force", surface="terrain")
