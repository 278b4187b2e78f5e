from gaitsim.component import Attachment, Component, Output


class RelativePosition(Component):
    """Position of one frame relative to another along the world's axes, such as that of a foot seen from the hip."""

    frame = Attachment("The frame.")
    origin = Attachment("The frame from which its position is measured.")
    x = Output("m", "Position of the frame along the world's x axis.")
    y = Output("m", "Its position along the y axis.")
    z = Output("m", "Its height.")
    origin_x = Output("m", "Position of the origin along the world's x axis.")
    origin_y = Output("m", "Its position along the y axis.")
    origin_z = Output("m", "Its height.")
    forward = Output("m", "Distance of the frame in front of the origin.")
    left = Output("m", "Distance of the frame to the left of the origin.")
    up = Output("m", "Height of the frame above the origin.")

    @staticmethod
    def output(p, u, x, y):
        y.forward = y.x - y.origin_x
        y.left = y.y - y.origin_y
        y.up = y.z - y.origin_z

    @staticmethod
    def build(p, mj):
        place = mj.position_of(mj.attached("frame"))
        origin = mj.position_of(mj.attached("origin"), suffix="origin")
        mj.read("x", place, "sensordata", 0)
        mj.read("y", place, "sensordata", 1)
        mj.read("z", place, "sensordata", 2)
        mj.read("origin_x", origin, "sensordata", 0)
        mj.read("origin_y", origin, "sensordata", 1)
        mj.read("origin_z", origin, "sensordata", 2)
