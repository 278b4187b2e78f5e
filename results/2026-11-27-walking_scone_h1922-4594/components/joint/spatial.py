from gaitsim.component import Attachment, Component, Input, Option, Output, Parameter, Refused


class Spatial(Component):
    """Root joint of a model in space: the child translates and rotates freely.

    Position and rotation are those of the child's frame relative to the parent. Rotations are in the order yaw (to the
    left), roll (to the right, about the child's forward axis), pitch (forwards). This is the order of rotation,
    obliquity and tilt of a pelvis (Baker 2001), which does not depend on the direction of walking.
    At a roll of 90 deg, lying on the side, the axes of yaw and pitch coincide and their rates are unbounded.
    `initial:` may set any of the twelve coordinates and rates.
    """

    parent = Attachment("The reference frame, usually world.")
    child = Attachment("The frame that moves.")
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
    left_force = Input("N", "Force on the child's frame, to the left.", sums=True)
    upward_force = Input("N", "Force on the child's frame, upwards.", sums=True)
    yaw_moment = Input("N m", "Moment that turns the child to the left.", sums=True)
    roll_moment = Input("N m", "Moment that leans the child to its right.", sums=True)
    pitch_moment = Input("N m", "Moment that leans the child forwards.", sums=True)
    x = Output("m", "Forward position of the child.")
    y = Output("m", "Position of the child to the left.")
    z = Output("m", "Height of the child above the parent.")
    yaw = Output("rad", "Rotation of the child to the left.", usual=(-6.3, 6.3))
    roll = Output("rad", "Lean of the child to its right.", usual=(-1.5, 1.5))
    pitch = Output("rad", "Forward lean of the child.", usual=(-6.3, 6.3))
    forward_velocity = Output("m/s", "Rate of x.")
    left_velocity = Output("m/s", "Rate of y.")
    upward_velocity = Output("m/s", "Rate of z.")
    yaw_velocity = Output("rad/s", "Rate of the yaw.")
    roll_velocity = Output("rad/s", "Rate of the roll.")
    pitch_velocity = Output("rad/s", "Rate of the pitch.")

    @staticmethod
    def build(p, mj):
        forwards = mj.slide(axis=(1, 0, 0), suffix="x")
        leftwards = mj.slide(axis=(0, 1, 0), suffix="y")
        upwards = mj.slide(axis=(0, 0, 1), suffix="z")
        if p.pose == "standing":
            mj.stands_on(upwards, load=p.load)
        elif p.load > 0:
            raise Refused(
                f"load is {p.load:g}, but pose: free puts nothing on the ground; choose standing, or remove load"
            )
        turning = mj.hinge(axis=(0, 0, 1), suffix="yaw")
        rolling = mj.hinge(axis=(1, 0, 0), suffix="roll")
        leaning = mj.hinge(axis=(0, 1, 0), suffix="pitch")
        mj.read("x", forwards, "qpos")
        mj.read("y", leftwards, "qpos")
        mj.read("z", upwards, "qpos")
        mj.read("yaw", turning, "qpos")
        mj.read("roll", rolling, "qpos")
        mj.read("pitch", leaning, "qpos")
        mj.read("forward_velocity", forwards, "qvel")
        mj.read("left_velocity", leftwards, "qvel")
        mj.read("upward_velocity", upwards, "qvel")
        mj.read("yaw_velocity", turning, "qvel")
        mj.read("roll_velocity", rolling, "qvel")
        mj.read("pitch_velocity", leaning, "qvel")
        mj.apply("forward_force", forwards, "qfrc_applied")
        mj.apply("left_force", leftwards, "qfrc_applied")
        mj.apply("upward_force", upwards, "qfrc_applied")
        mj.apply("yaw_moment", turning, "qfrc_applied")
        mj.apply("roll_moment", rolling, "qfrc_applied")
        mj.apply("pitch_moment", leaning, "qfrc_applied")
