from gaitsim.component import Attachment, Component, Input, Option, Output


class Planar(Component):
    """The root of a planar body: the child moves forwards, up and about the y axis, and no other way.

    Place and pitch are those of the child's frame seen from the parent. A positive pitch leans an
    upright child forwards. `initial:` may set any of the six coordinates and rates.
    """

    parent = Attachment("The frame from which the child is seen, as a rule world.")
    child = Attachment("The frame that moves in the plane.")
    pose = Option(
        "standing: unless `initial:` sets z, the lowest contact touches the ground at the start.",
        choices=("standing", "free"),
        default="standing",
    )
    forward_force = Input("N", "Force on the child's frame, forwards.", sums=True)
    upward_force = Input("N", "Force on the child's frame, upwards.", sums=True)
    moment = Input("N m", "Moment that leans the child forwards.", sums=True)
    x = Output("m", "How far the child is in front of the parent.")
    z = Output("m", "How high the child is above the parent.")
    pitch = Output("rad", "How far the child leans forwards.", usual=(-6.3, 6.3))
    forward_velocity = Output("m/s", "Rate of x.")
    upward_velocity = Output("m/s", "Rate of z.")
    pitch_velocity = Output("rad/s", "Rate of the pitch.")

    @staticmethod
    def build(p, mj):
        forwards = mj.slide(axis=(1, 0, 0), suffix="x")
        upwards = mj.slide(axis=(0, 0, 1), suffix="z")
        if p.pose == "standing":
            mj.stands_on(upwards)
        leaning = mj.hinge(axis=(0, 1, 0), suffix="pitch")
        mj.read("x", forwards, "qpos")
        mj.read("z", upwards, "qpos")
        mj.read("pitch", leaning, "qpos")
        mj.read("forward_velocity", forwards, "qvel")
        mj.read("upward_velocity", upwards, "qvel")
        mj.read("pitch_velocity", leaning, "qvel")
        mj.apply("forward_force", forwards, "qfrc_applied")
        mj.apply("upward_force", upwards, "qfrc_applied")
        mj.apply("moment", leaning, "qfrc_applied")
