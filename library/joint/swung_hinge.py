from gaitsim.component import Attachment, Component, Input, Output


class SwungHinge(Component):
    """Hip of a walker whose legs exchange roles at an impact, which resets angle and angular velocity.

    A positive angle turns the hanging leg backwards.
    """

    parent = Attachment("The hip of the stance leg.")
    child = Attachment("The hip of the swing leg.")
    torque = Input("N m", "Torque on the swing leg, backwards.", sums=True)
    struck = Input("1", "1 in the instant of an impact.", default=0)
    new_angle = Input("rad", "Angle after an impact.", default=0)
    new_rate = Input("rad/s", "Rate of the angle after an impact.", default=0)
    angle = Output("rad", "Angle of the swing leg from the stance leg.", usual=(-6.3, 6.3))
    velocity = Output("rad/s", "Rate of the angle.")

    @staticmethod
    def build(p, mj):
        joint = mj.hinge(axis=(0, 1, 0))
        mj.read("angle", joint, "qpos")
        mj.read("velocity", joint, "qvel")
        mj.apply("torque", joint, "qfrc_applied")
        mj.reset("new_angle", "struck", joint, "qpos")
        mj.reset("new_rate", "struck", joint, "qvel")
