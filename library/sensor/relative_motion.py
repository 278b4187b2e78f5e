import math

from gaitsim.component import Attachment, Component, Input, Output


class RelativeMotion(Component):
    """Position of one place relative to another, and its velocity over the ground, along a heading.

    An example is the trunk's center of mass relative to an ankle. For a part of the left side (`sides: [l, r]`), medial
    is to the right, else to the left.
    """

    frame = Attachment("The place.")
    origin = Attachment("The place relative to which it is measured.")
    heading = Input("rad", "Forward direction: angle to the left.", default=0)
    side = Output("1", "-1 for a part of the left side, else 1.")
    x = Output("m", "Position of the place along the world's x axis.")
    y = Output("m", "Its position along the y axis.")
    origin_x = Output("m", "Position of the origin along the world's x axis.")
    origin_y = Output("m", "Its position along the y axis.")
    x_velocity = Output("m/s", "Velocity of the place along the world's x axis.")
    y_velocity = Output("m/s", "Its velocity along the y axis.")
    forward = Output("m", "How far the place is in front of the origin.")
    medial = Output("m", "How far it is towards the other side.")
    forward_velocity = Output("m/s", "Velocity of the place, forwards.")
    medial_velocity = Output("m/s", "Its velocity towards the other side.")

    @staticmethod
    def output(p, u, x, y):
        ahead, left = math.cos(u.heading), math.sin(u.heading)
        along, across = y.x - y.origin_x, y.y - y.origin_y
        y.forward = ahead * along + left * across
        y.medial = y.side * (ahead * across - left * along)
        y.forward_velocity = ahead * y.x_velocity + left * y.y_velocity
        y.medial_velocity = y.side * (ahead * y.y_velocity - left * y.x_velocity)

    @staticmethod
    def build(p, mj):
        frame = mj.attached("frame")
        place, velocity = mj.position_of(frame), mj.velocity_of(frame)
        origin = mj.position_of(mj.attached("origin"), suffix="origin")
        mj.read_side("side")
        mj.read("x", place, "sensordata", 0)
        mj.read("y", place, "sensordata", 1)
        mj.read("origin_x", origin, "sensordata", 0)
        mj.read("origin_y", origin, "sensordata", 1)
        mj.read("x_velocity", velocity, "sensordata", 0)
        mj.read("y_velocity", velocity, "sensordata", 1)
