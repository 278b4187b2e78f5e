from gaitsim.component import Attachment, Component, Output, Parameter


class SpringDamper(Component):
    """Vertical spring and damper side by side under one point of a body, on level ground.

    F = k d + b d', never negative: the ground does not pull. No friction; where a point may
    slip, another contact is needed.
    """

    frame = Attachment("The point that touches the ground.")
    stiffness = Parameter("N/m", "k.", bounds=(1, 1e8))
    damping = Parameter("N s/m", "b.", bounds=(0, 1e6))
    height = Output("m", "Height of the point above the ground.")
    velocity = Output("m/s", "Upward velocity of the point.")
    weight = Output("N", "Weight of all that moves.")
    force = Output("N", "Force of the ground on the point, upwards.")
    load = Output("1", "Force in weights of all that moves; 0 without gravity.")
    in_contact = Output("1", "1 while the point is below the ground's surface, else 0.")
    energy = Output("J", "Elastic energy in the ground, k d^2 / 2.")

    @staticmethod
    def output(p, u, x, y):
        depth = max(0.0, -y.height)
        y.in_contact = 1.0 if y.height < 0 else 0.0
        y.force = y.in_contact * max(0.0, p.stiffness * depth - p.damping * y.velocity)
        y.load = y.force / y.weight if y.weight > 0 else 0.0
        y.energy = 0.5 * p.stiffness * depth**2

    @staticmethod
    def build(p, mj):
        ground = mj.push(mj.attached("frame"), axis=(0, 0, 1))
        mj.read("height", ground, "actuator_length")
        mj.read("velocity", ground, "actuator_velocity")
        mj.read_weight("weight")
        mj.apply("force", ground, "ctrl")
