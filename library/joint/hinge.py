from gaitsim.component import Attachment, Component, Input, Output, Parameter


class Hinge(Component):
    """A hinge in the sagittal plane: about the y axis, which points to the left.

    A positive angle turns a hanging child backwards, as in knee flexion.
    """

    parent = Attachment("The frame that holds the hinge.")
    child = Attachment("The frame that turns.")
    damping = Parameter(
        "N m s/rad",
        "Viscous damping.",
        default=0,
        bounds=(0, 1000),
        source="definition: an ideal hinge",
    )
    torque = Input("N m", "Torque on the child about the hinge's axis.", sums=True)
    angle = Output("rad", "Angle from the posture in which the two frames are aligned.", usual=(-6.3, 6.3))
    velocity = Output("rad/s", "Angular velocity.")

    @staticmethod
    def build(p, mj):
        joint = mj.hinge(axis=(0, 1, 0), damping=p.damping)
        mj.read("angle", joint, "qpos")
        mj.read("velocity", joint, "qvel")
        mj.apply("torque", joint, "qfrc_applied")
