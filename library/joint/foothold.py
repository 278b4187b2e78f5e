from gaitsim.component import Attachment, Component, Input, Output, Parameter


class Foothold(Component):
    """A foot on the ground that is set down elsewhere in an instant: a pin joint that impacts move.

    The foot does not move while it stands: two slides with an armature far above any mass hold it. What an impact sends
    is the place, the angle and the rate that the joint has after it.
    """

    parent = Attachment("The frame in which the foot is placed, as a rule world.")
    child = Attachment("The foot.")
    hold = Parameter(
        "kg", "Armature of the slides.", default=1e15, bounds=(1e9, 1e18), source="definition: beyond any body's mass"
    )
    torque = Input("N m", "Torque that turns the leg forwards.", sums=True)
    struck = Input("1", "1 in the instant of an impact.", default=0)
    new_x = Input("m", "Where the foot stands after an impact.", default=0)
    new_z = Input("m", "How high it stands then.", default=0)
    new_angle = Input("rad", "Angle after an impact.", default=0)
    new_rate = Input("rad/s", "Rate of the angle after an impact.", default=0)
    x = Output("m", "How far ahead the foot stands.")
    z = Output("m", "How high the foot stands.")
    angle = Output("rad", "How far the leg leans forwards from the vertical.", usual=(-6.3, 6.3))
    velocity = Output("rad/s", "Rate of the angle.")
    rest = Output("m/s", "Velocity of the foot after an impact: none.")

    @staticmethod
    def output(p, u, x, y):
        y.rest = 0.0

    @staticmethod
    def build(p, mj):
        forwards = mj.slide(axis=(1, 0, 0), suffix="x", armature=p.hold)
        upwards = mj.slide(axis=(0, 0, 1), suffix="z", armature=p.hold)
        leaning = mj.hinge(axis=(0, 1, 0))
        mj.read("x", forwards, "qpos")
        mj.read("z", upwards, "qpos")
        mj.read("angle", leaning, "qpos")
        mj.read("velocity", leaning, "qvel")
        mj.apply("torque", leaning, "qfrc_applied")
        mj.reset("new_x", "struck", forwards, "qpos")
        mj.reset("rest", "struck", forwards, "qvel")
        mj.reset("new_z", "struck", upwards, "qpos")
        mj.reset("rest", "struck", upwards, "qvel")
        mj.reset("new_angle", "struck", leaning, "qpos")
        mj.reset("new_rate", "struck", leaning, "qvel")
