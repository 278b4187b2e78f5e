import math

from gaitsim.component import Attachment, Component, Curve, Input, Output, Parameter, Part, StepLimit


class SpringDamper(Component):
    """A spring and a damper side by side under one point of a body, along the ground's normal.

    F = k d + b d', never negative. It has no friction, so it suits points that do not move along the ground.
    """

    frame = Attachment("The point that touches the ground.")
    stiffness = Parameter("N/m", "k: stiffness.", bounds=(1, 1e8))
    damping = Parameter("N s/m", "b: damping.", bounds=(0, 1e6))
    terrain = Part(
        "terrain",
        "The ground.",
        default="terrain/flat",
        reads=(("ground_height", "height"), ("gradient", "gradient")),
        sends=(("position", "position"),),
    )
    ground_height = Input("m", "Height of the ground below the point.", default=0)
    gradient = Input("1", "How much the ground rises there, forwards.", default=0)
    position = Output("m", "Position of the point along the ground.")
    place_height = Output("m", "Height of the point, from the same zero as heights of the ground.")
    height = Output("m", "Height of the point above the ground.", usual=(-0.03, 100), possible=(-0.3, 1e4))
    velocity = Output("m/s", "Upward velocity of the point.")
    weight = Output("N", "Weight of the whole model.")
    force = Output("N", "Force of the ground on the point, upwards.")
    friction_force = Output("N", "Force of the ground on the point, forwards; 0 where the ground does not rise.")
    load = Output("1", "Force in body weights; 0 without gravity.", usual=(0, 3), possible=(0, 20))
    in_contact = Output("1", "1 while the point is below the ground's surface, else 0.")
    energy = Output("J", "Elastic energy in the ground, k d^2 / 2.")

    largest_step = StepLimit(
        "ms",
        "80 kg on a foot of 1.25 kg landing on its heel at 0.5 m/s, 78 kN/m and 500 N s/m: peak force within 1 % of "
        "that at 0.02 ms. The force is explicit: with a mass m at the point, steps must be well below 2 m / b.",
        0.5,
    )

    pressing = Curve(
        "force",
        "place_height",
        (-0.02, 0.005),
        "Force over height, k = 100 kN/m, b = 1 kN s/m.",
        at={"stiffness": 1e5, "damping": 1e3},
        each=("velocity", (-0.5, 0, 0.5)),
    )
    moving = Curve(
        "force",
        "velocity",
        (-1, 1.5),
        "Force over velocity, k = 100 kN/m, b = 1 kN s/m.",
        at={"stiffness": 1e5, "damping": 1e3},
        each=("place_height", (-0.005, -0.01)),
    )

    @staticmethod
    def output(p, u, x, y):
        longer = math.sqrt(1 + u.gradient**2)
        y.height = (y.place_height - u.ground_height) / longer
        depth = max(0.0, -y.height)
        y.in_contact = 1.0 if depth > 0 else 0.0
        y.force = y.in_contact * max(0.0, p.stiffness * depth / longer - p.damping * y.velocity)
        y.friction_force = -u.gradient * y.force
        y.load = y.force / y.weight if y.weight > 0 else 0.0
        y.energy = 0.5 * p.stiffness * depth**2

    @staticmethod
    def build(p, mj):
        point = mj.attached("frame")
        along = mj.push(point, axis=(1, 0, 0), suffix="along", surface="terrain")
        ground = mj.push(point, axis=(0, 0, 1), surface="terrain")
        mj.read("position", along, "actuator_length")
        mj.read("place_height", ground, "actuator_length")
        mj.read("velocity", ground, "actuator_velocity")
        mj.touches(point)
        mj.read_weight("weight")
        mj.apply("force", ground, "ctrl")
        mj.tilt(point, surface="terrain", forward="friction_force")
        mj.draw_force(point, up="force", surface="terrain")
