from gaitsim.component import Attachment, Component, Curve, Output, Parameter


class Skeleton(Component):
    """A vertical force on a point below level ground, F = k d (1 - c d'); replace it by your equations."""

    frame = Attachment("The point that touches the ground.")
    stiffness = Parameter(
        "N/m", "k: stiffness.", default=1e5, bounds=(1, 1e8), source="definition: 80 kg sink in by 8 mm"
    )
    dissipation = Parameter(
        "s/m",
        "c: dissipation; reduces the force while the point moves up.",
        default=0.5,
        bounds=(0, 10),
        source="definition: a starting value",
    )
    position = Output("m", "Position of the point along the ground.")
    height = Output("m", "Height of the point above the ground.", usual=(-0.03, 100), possible=(-0.3, 1e4))
    velocity = Output("m/s", "Upward velocity of the point.")
    weight = Output("N", "Weight of the whole model.")
    force = Output("N", "Force of the ground on the point, upwards.")
    friction_force = Output("N", "Forward force along the ground; 0 here.")
    load = Output("1", "Force in body weights; 0 without gravity.", usual=(0, 3), possible=(0, 20))
    in_contact = Output("1", "1 while the point is below the ground's surface, else 0.")
    energy = Output("J", "Elastic energy in the ground, k d^2 / 2.")

    pressing = Curve("force", "height", (-0.02, 0.005), "Force over height.", each=("velocity", (-0.5, 0, 0.5)))

    @staticmethod
    def output(p, u, x, y):
        depth = max(0.0, -y.height)
        y.in_contact = 1.0 if y.height < 0 else 0.0
        y.force = max(0.0, p.stiffness * depth * (1 - p.dissipation * y.velocity))
        y.friction_force = 0.0
        y.load = y.force / y.weight if y.weight > 0 else 0.0
        y.energy = 0.5 * p.stiffness * depth**2

    @staticmethod
    def build(p, mj):
        point = mj.attached("frame")
        ground = mj.push(point, axis=(0, 0, 1))
        mj.read("position", mj.position_of(point), "sensordata", 0)
        mj.read("height", ground, "actuator_length")
        mj.read("velocity", ground, "actuator_velocity")
        mj.read_weight("weight")
        mj.apply("force", ground, "ctrl")
