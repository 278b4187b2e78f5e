from gaitsim.component import Attachment, Component, Input, Output


class Rail(Component):
    """A rail."""

    parent = Attachment("The frame that holds the rail.")
    child = Attachment("The frame that slides.")
    force = Input("N", "Force along the rail.", sums=True)
    position = Output("m", "Place along the rail.")
    velocity = Output("m/s", "Velocity along the rail.")

    @staticmethod
    def build(p, mj):
        joint = mj.slide(axis=(1, 0, 0))
        mj.read("position", joint, "qpos")
        mj.reset("force", "force", joint, "qfrc_applied")
        mj.read("velocity", joint, "qvel")
        mj.apply("force", joint, "qfrc_applied")
