import math

from gaitsim.component import Attachment, Component, Input, Option, Output, Parameter, Part, StepLimit


class Mujoco(Component):
    """MuJoCo's own contact: a sphere at a point of a body against the ground, with friction in both directions.

    It has no stiffness in N/m. Depth and closing velocity set an acceleration, so the depth does not depend on mass.
    The solver computes the force after all outputs, so the force that is read is one step old. On uneven ground, the
    sphere rests on the plane that touches the ground below its center, as it was one step before.
    """

    frame = Attachment("The center of the sphere.")
    law = Option(
        "Parameters of the constraint: time constant and damping ratio, or stiffness and damping.",
        choices=("time_constant", "stiffness"),
        default="time_constant",
    )
    radius = Parameter("m", "Radius of the sphere.", default=0.02, bounds=(1e-3, 1), source="definition: a choice")
    time_constant = Parameter(
        "s", "First number of solref.", default=0.02, bounds=(1e-6, 10), source="definition: MuJoCo's default"
    )
    damping_ratio = Parameter(
        "1", "Second number of solref.", default=1, bounds=(1e-3, 100), source="definition: MuJoCo's default"
    )
    reference_stiffness = Parameter(
        "1/s^2",
        "K: minus the first number of a direct solref.",
        default=1e4,
        bounds=(1, 1e9),
        source="definition: a choice",
    )
    reference_damping = Parameter(
        "1/s",
        "B: minus the second number of a direct solref; critical at 2 sqrt(K).",
        default=200,
        bounds=(0, 1e6),
        source="definition: critical for the default K",
    )
    impedance_low = Parameter(
        "1", "solimp: d at no depth.", default=0.9, bounds=(1e-4, 0.9999), source="definition: MuJoCo's default"
    )
    impedance_high = Parameter(
        "1", "solimp: d beyond the width.", default=0.95, bounds=(1e-4, 0.9999), source="definition: MuJoCo's default"
    )
    impedance_width = Parameter(
        "m",
        "solimp: depth over which d changes.",
        default=0.001,
        bounds=(1e-9, 1),
        source="definition: MuJoCo's default",
    )
    impedance_middle = Parameter(
        "1", "solimp: where the change is half done.", default=0.5, bounds=(0, 1), source="definition: MuJoCo's default"
    )
    impedance_power = Parameter(
        "1", "solimp: shape of the change.", default=2, bounds=(1, 10), source="definition: MuJoCo's default"
    )
    friction = Parameter(
        "1", "Coefficient of friction.", default=1, bounds=(0, 10), source="definition: MuJoCo's default"
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
    slope = Output("rad", "Slope of the mean ground in the forward direction.")
    side_slope = Output("rad", "Slope of the mean ground to the left, about its forward direction.")
    tilt = Output(
        "1",
        "First number of the quaternion that turns the plane below: 1 + sqrt(1 + g^2 + h^2), g and h the gradients.",
    )
    position = Output("m", "Position of the sphere's center along the ground, forwards.")
    side_position = Output("m", "Position of the sphere's center along the ground, to the left.")
    center_height = Output("m", "Height of the sphere's center.")
    height = Output(
        "m", "Height of the sphere's lowest point above the ground.", usual=(-0.03, 100), possible=(-0.3, 1e4)
    )
    weight = Output("N", "Weight of the whole model.")
    pushed_forwards = Output("N", "Forward force of the sphere on the ground, in the world.")
    pushed_left = Output("N", "Force of the sphere on the ground to the left, in the world.")
    pushed_upwards = Output("N", "Upward force of the sphere on the ground, in the world.")
    force = Output("N", "Force of the ground on the sphere, along the mean ground's normal; one step old.")
    friction_force = Output("N", "Force of the ground on the sphere along the mean ground, forwards; one step old.")
    side_force = Output("N", "Force of the ground on the sphere along the mean ground, to the left; one step old.")
    load = Output("1", "Force in body weights; one step old.", usual=(0, 3), possible=(0, 20))
    in_contact = Output("1", "1 while the sphere is below the ground's surface, else 0.")
    energy = Output("J", "Elastic energy, computed as that of a linear spring: force times depth / 2; one step old.")

    largest_step = StepLimit(
        "ms",
        "80 kg on a foot of 1.25 kg landing on its heel at 0.5 m/s, default numbers: peak force within 5 % of that at "
        "0.02 ms. A time constant below 2 steps is raised to that by MuJoCo.",
        1,
    )

    @staticmethod
    def output(p, u, x, y):
        longer = math.sqrt(1 + u.gradient**2 + u.side_gradient**2)
        y.tilt = 1 + longer
        y.height = (y.center_height - p.radius - u.ground_height + p.radius * (1 - longer)) / longer
        y.in_contact = 1.0 if y.height < 0 else 0.0
        cosine, sine = math.cos(y.slope), math.sin(y.slope)
        side_cosine, side_sine = math.cos(y.side_slope), math.sin(y.side_slope)
        normal = y.pushed_forwards * sine - y.pushed_upwards * cosine
        y.friction_force = -y.pushed_forwards * cosine - y.pushed_upwards * sine
        y.force = normal * side_cosine + y.pushed_left * side_sine
        y.side_force = normal * side_sine - y.pushed_left * side_cosine
        y.load = y.force / y.weight if y.weight > 0 else 0.0
        y.energy = 0.5 * y.force * max(0.0, -y.height)

    @staticmethod
    def build(p, mj):
        center = mj.attached("frame")
        direct = p.law == "stiffness"
        touch = mj.collide(
            center,
            p.radius,
            friction=p.friction,
            solref=(-p.reference_stiffness, -p.reference_damping) if direct else (p.time_constant, p.damping_ratio),
            solimp=(p.impedance_low, p.impedance_high, p.impedance_width, p.impedance_middle, p.impedance_power),
        )
        mj.read("pushed_forwards", touch, "sensordata", 0)
        mj.read("pushed_left", touch, "sensordata", 1)
        mj.read("pushed_upwards", touch, "sensordata", 2)
        mj.follow_ground(
            "position", "side_position", "ground_height", "tilt", "gradient", "side_gradient", surface="terrain"
        )
        mj.read_slopes("slope", "side_slope", surface="terrain")
        place = mj.position_of(center, surface="terrain")
        mj.read("position", place, "sensordata", 0)
        mj.read("side_position", place, "sensordata", 1)
        mj.read("center_height", place, "sensordata", 2)
        mj.touches(center, p.radius)
        mj.read_weight("weight")
        mj.draw_force(center, up="force", forward="friction_force", left="side_force", surface="terrain")
