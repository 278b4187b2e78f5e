from gaitsim.component import Attachment, Component, Input, Output, Parameter


class Foothold(Component):
    """A pin joint at the stance foot, which an impact moves to the next foothold.

    During stance, two slides with an armature far above any mass keep the foot in place. An impact sends the position,
    the angle and the angular velocity of the joint after it.
    """

    parent = Attachment("The frame in which the foot is placed, usually world.")
    child = Attachment("The foot.")
    hold = Parameter(
        "kg", "Armature of the slides.", default=1e15, bounds=(1e9, 1e18), source="definition: beyond any body's mass"
    )
    torque = Input("N m", "Torque that turns the leg forwards.", sums=True)
    struck = Input("1", "1 in the instant of an impact.", default=0)
    new_x = Input("m", "Position of the foot after an impact.", default=0)
    new_z = Input("m", "Height of the foot after an impact.", default=0)
    new_angle = Input("rad", "Angle after an impact.", default=0)
    new_rate = Input("rad/s", "Rate of the angle after an impact.", default=0)
    x = Output("m", "Forward position of the foot.")
    z = Output("m", "Height of the foot.")
    angle = Output("rad", "Forward lean of the leg from the vertical.", usual=(-6.3, 6.3))
    velocity = Output("rad/s", "Rate of the angle.")
    rest = Output("m/s", "Velocity of the foot after an impact; always 0.")

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
