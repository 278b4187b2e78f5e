from gaitsim.component import Attachment, Component, Option, Output, Parameter


class Mujoco(Component):
    """MuJoCo's own contact: a sphere at a point of a body against level ground, with friction.

    It has no force law in N/m: depth and rate of closing set an acceleration, so penetration does
    not depend on mass. Its force comes from the solver after all outputs: what is read is one
    step old.
    """

    frame = Attachment("The center of the sphere.")
    law = Option(
        "Which pair says how a depth is closed: time constant and damping ratio, or stiffness and damping.",
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
    center_height = Output("m", "Height of the sphere's center.")
    height = Output("m", "Height of the sphere's lowest point above the ground.")
    weight = Output("N", "Weight of all that moves.")
    touch = Output("N", "Normal force as the solver left it.")
    force = Output("N", "Force of the ground on the sphere, upwards; one step old.")
    load = Output("1", "Force in weights of all that moves; one step old.")
    in_contact = Output("1", "1 while the sphere is below the ground's surface, else 0.")
    energy = Output("J", "Elastic energy as of a linear spring, force times depth / 2; one step old.")

    @staticmethod
    def output(p, u, x, y):
        y.height = y.center_height - p.radius
        y.in_contact = 1.0 if y.height < 0 else 0.0
        y.force = y.touch
        y.load = y.touch / y.weight if y.weight > 0 else 0.0
        y.energy = 0.5 * y.touch * max(0.0, -y.height)

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
        mj.read("touch", touch, "sensordata")
        mj.read("center_height", mj.position_of(center), "sensordata", 2)
        mj.read_weight("weight")
