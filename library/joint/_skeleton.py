from gaitsim.component import Attachment, Component, Curve, Input, Output, Parameter


class Skeleton(Component):
    """A hinge about the y axis with a spring, M = -k (phi - phi_0); replace it by your equations."""

    parent = Attachment("The frame that holds the hinge.")
    child = Attachment("The frame that turns.")
    stiffness = Parameter(
        "N m/rad", "k: stiffness.", default=10, bounds=(0, 1e6), source="definition: a starting value"
    )
    rest = Parameter("rad", "phi_0: angle without torque.", default=0, bounds=(-6.3, 6.3), source="definition: aligned")
    torque = Input("N m", "Torque on the child about the hinge's axis.", sums=True)
    angle = Output("rad", "Angle from the posture in which the two frames are aligned.", usual=(-6.3, 6.3))
    velocity = Output("rad/s", "Angular velocity.")
    total = Output("N m", "Torque of the spring and the senders together.")

    spring = Curve("total", "angle", (-1.5, 1.5), "Torque over the angle.")

    @staticmethod
    def output(p, u, x, y):
        y.total = u.torque - p.stiffness * (y.angle - p.rest)

    @staticmethod
    def build(p, mj):
        joint = mj.hinge(axis=(0, 1, 0))
        mj.read("angle", joint, "qpos")
        mj.read("velocity", joint, "qvel")
        mj.apply("total", joint, "qfrc_applied")
