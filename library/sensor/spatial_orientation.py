import math

from gaitsim.component import Attachment, Component, Output, State


def continued(angle, before):
    """The angle with as many whole turns added as bring it nearest to what it was before."""
    return before + (angle - before + math.pi) % (2 * math.pi) - math.pi


class SpatialOrientation(Component):
    """How a segment is turned in the world: by a yaw, a roll and a pitch in this order, as joint/spatial has them.

    Yaw and pitch go on through whole turns. The rates are the angular velocities about the world's axes: about those of
    the angles while these are small. Of a part of the left side (`sides: [l, r]`), yaw and roll turn
    round, so that both sides feel the same in mirrored postures.
    """

    frame = Attachment("A frame of the segment, such as torso.center.")
    side = Output("1", "-1 for a part of the left side, else 1.")
    x_up = Output("1", "How far upwards the segment's own x axis points.")
    y_ahead = Output("1", "How far forwards its own y axis points.")
    y_left = Output("1", "How far to the left its own y axis points.")
    y_up = Output("1", "How far upwards its own y axis points.")
    z_up = Output("1", "How far upwards its own z axis points.")
    about_forward = Output("rad/s", "Angular velocity about the world's x axis.")
    about_up = Output("rad/s", "Angular velocity about the world's z axis.")
    yaw_before = State("rad", "Yaw one step ago.")
    pitch_before = State("rad", "Pitch one step ago.")
    yaw = Output("rad", "Turn to the left; on the left side, to the right.")
    roll = Output("rad", "Lean to the right; on the left side, to the left.")
    pitch = Output("rad", "Lean forwards.")
    yaw_velocity = Output("rad/s", "Angular velocity to the left; on the left side, to the right.")
    roll_velocity = Output("rad/s", "Angular velocity to the right; on the left side, to the left.")
    pitch_velocity = Output("rad/s", "Angular velocity forwards.")

    @staticmethod
    def output(p, u, x, y):
        y.yaw = continued(y.side * math.atan2(-y.y_ahead, y.y_left), x.yaw_before)
        y.roll = y.side * math.asin(max(-1.0, min(1.0, y.y_up)))
        y.pitch = continued(math.atan2(-y.x_up, y.z_up), x.pitch_before)
        y.yaw_velocity = y.side * y.about_up
        y.roll_velocity = y.side * y.about_forward

    @staticmethod
    def update(p, u, x, y, dt):
        x.yaw_before, x.pitch_before = y.yaw, y.pitch

    @staticmethod
    def build(p, mj):
        own_x, own_y, own_z, velocity = mj.axes_of(mj.attached("frame"))
        mj.read_side("side")
        mj.read("x_up", own_x, "sensordata", 2)
        mj.read("y_ahead", own_y, "sensordata", 0)
        mj.read("y_left", own_y, "sensordata", 1)
        mj.read("y_up", own_y, "sensordata", 2)
        mj.read("z_up", own_z, "sensordata", 2)
        mj.read("about_forward", velocity, "sensordata", 0)
        mj.read("pitch_velocity", velocity, "sensordata", 1)
        mj.read("about_up", velocity, "sensordata", 2)
