from gaitsim.component import Attachment, Component, Input, Option, Output, Parameter, Refused


class Planar(Component):
    """Root joint of a planar model: the child moves forwards, upwards and about the y axis only.

    Position and pitch are those of the child's frame relative to the parent. A positive pitch is a forward
    lean. `initial:` may set any of the six coordinates and rates.
    """

    parent = Attachment("The reference frame, usually world.")
    child = Attachment("The frame that moves in the plane.")
    pose = Option(
        "standing: unless `initial:` sets z, the lowest contact touches the ground at the start.",
        choices=("standing", "free"),
        default="standing",
    )
    load = Parameter(
        "1",
        "Share of the body weight that the ground carries at the start, instead of the first touch.",
        default=0,
        bounds=(0, 10),
        source="definition: the first touch",
    )
    forward_force = Input("N", "Force on the child's frame, forwards.", sums=True)
    upward_force = Input("N", "Force on the child's frame, upwards.", sums=True)
    moment = Input("N m", "Moment that leans the child forwards.", sums=True)
    x = Output("m", "Forward position of the child.")
    z = Output("m", "Height of the child above the parent.")
    pitch = Output("rad", "Forward lean of the child.", usual=(-6.3, 6.3))
    forward_velocity = Output("m/s", "Rate of x.")
    upward_velocity = Output("m/s", "Rate of z.")
    pitch_velocity = Output("rad/s", "Rate of the pitch.")

    @staticmethod
    def build(p, mj):
        forwards = mj.slide(axis=(1, 0, 0), suffix="x")
        upwards = mj.slide(axis=(0, 0, 1), suffix="z")
        if p.pose == "standing":
            mj.stands_on(upwards, load=p.load)
        elif p.load > 0:
            raise Refused(
                f"load is {p.load:g}, but pose: free puts nothing on the ground; choose standing, or remove load"
            )
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
