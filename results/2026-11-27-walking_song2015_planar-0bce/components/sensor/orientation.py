import math

from gaitsim.component import Attachment, Component, Output, State


def continued(angle, before):
    """The angle plus the number of whole turns that brings it closest to its previous value."""
    return before + (angle - before + math.pi) % (2 * math.pi) - math.pi


class Orientation(Component):
    """Pitch of a segment in the world's sagittal plane: 0 while its own z axis points up, forwards positive.

    The angle is that of the z axis seen from the left, atan2(z_x, z_z), and continues beyond whole turns.
    The rate is the angular velocity about the world's y axis; it is the rate of the pitch as long as
    the segment moves in the sagittal plane.
    """

    frame = Attachment("A frame of the segment, such as trunk.hip.")
    ahead = Output("1", "Forward component of the segment's z axis.")
    up = Output("1", "Upward component of the segment's z axis.")
    rate = Output("rad/s", "Rate of the pitch.")
    before = State("rad", "Pitch one step ago.")
    pitch = Output("rad", "Pitch; a forward lean is positive.")

    @staticmethod
    def output(p, u, x, y):
        y.pitch = continued(math.atan2(y.ahead, y.up), x.before)

    @staticmethod
    def update(p, u, x, y, dt):
        x.before = y.pitch

    @staticmethod
    def build(p, mj):
        axis, velocity = mj.orientation_of(mj.attached("frame"))
        mj.read("ahead", axis, "sensordata", 0)
        mj.read("up", axis, "sensordata", 2)
        mj.read("rate", velocity, "sensordata", 1)
