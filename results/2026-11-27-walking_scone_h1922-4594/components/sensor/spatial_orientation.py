import math

from gaitsim.component import Attachment, Component, Output, State


def continued(angle, before):
    """The angle plus the number of whole turns that brings it closest to its previous value."""
    return before + (angle - before + math.pi) % (2 * math.pi) - math.pi


class SpatialOrientation(Component):
    """Orientation of a segment in the world: yaw to the left, then pitch forwards, then roll to the right.

    Rotations are intrinsic, as heading, pitch and bank of a vehicle. Yaw and roll continue beyond whole turns. Rates
    are angular velocities about the segment's own axes, as measured by a gyroscope. On the left side (`sides: [l,
    r]`), the signs of yaw and roll are reversed, so that mirrored postures give the same values on both sides.
    """

    frame = Attachment("A frame of the segment, such as torso.center.")
    side = Output("1", "-1 for a part of the left side, else 1.")
    x_ahead = Output("1", "Forward component of the segment's own x axis.")
    x_left = Output("1", "Leftward component of the segment's own x axis.")
    x_up = Output("1", "Upward component of the segment's own x axis.")
    y_up = Output("1", "Upward component of its own y axis.")
    z_up = Output("1", "Upward component of its own z axis.")
    about_x = Output("rad/s", "Angular velocity about its own x axis.")
    about_z = Output("rad/s", "Angular velocity about its own z axis.")
    yaw_before = State("rad", "Yaw one step ago.")
    roll_before = State("rad", "Roll one step ago.")
    yaw = Output("rad", "Rotation to the left; on the left side, to the right.")
    roll = Output("rad", "Lean to its right; on the left side, to its left.")
    pitch = Output("rad", "Lean forwards.")
    rise = Output("rad", "Elevation of its own side, -roll: the obliquity of a pelvis, the abduction of a thigh.")
    yaw_velocity = Output("rad/s", "Angular velocity to the left; on the left side, to the right.")
    roll_velocity = Output("rad/s", "Angular velocity to the right; on the left side, to the left.")
    pitch_velocity = Output("rad/s", "Angular velocity forwards.")
    rise_velocity = Output("rad/s", "Angular velocity that raises its own side.")

    @staticmethod
    def output(p, u, x, y):
        y.yaw = continued(y.side * math.atan2(y.x_left, y.x_ahead), x.yaw_before)
        y.roll = continued(y.side * math.atan2(y.y_up, y.z_up), x.roll_before)
        y.pitch = -math.asin(max(-1.0, min(1.0, y.x_up)))
        y.yaw_velocity = y.side * y.about_z
        y.roll_velocity = y.side * y.about_x
        y.rise, y.rise_velocity = -y.roll, -y.roll_velocity

    @staticmethod
    def update(p, u, x, y, dt):
        x.yaw_before, x.roll_before = y.yaw, y.roll

    @staticmethod
    def build(p, mj):
        own_x, own_y, own_z, velocity = mj.axes_of(mj.attached("frame"))
        mj.read_side("side")
        mj.read("x_ahead", own_x, "sensordata", 0)
        mj.read("x_left", own_x, "sensordata", 1)
        mj.read("x_up", own_x, "sensordata", 2)
        mj.read("y_up", own_y, "sensordata", 2)
        mj.read("z_up", own_z, "sensordata", 2)
        mj.read("about_x", velocity, "sensordata", 0)
        mj.read("pitch_velocity", velocity, "sensordata", 1)
        mj.read("about_z", velocity, "sensordata", 2)
