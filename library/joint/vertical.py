from gaitsim.component import Attachment, Component, Input, Output


class Vertical(Component):
    """A guide that lets the child translate along the vertical only."""

    parent = Attachment("The frame that holds the guide.")
    child = Attachment("The frame that is guided.")
    force = Input("N", "Force along the guide, upwards.", sums=True)
    position = Output("m", "Height of the child above the parent.")
    velocity = Output("m/s", "Upward velocity of the child.")

    @staticmethod
    def build(p, mj):
        joint = mj.slide(axis=(0, 0, 1))
        mj.read("position", joint, "qpos")
        mj.read("velocity", joint, "qvel")
        mj.apply("force", joint, "qfrc_applied")
