from gaitsim.component import Attachment, Component, Input, Output, Part


class Clearance(Component):
    """Height of a frame above the ground, along the ground's normal, such as that of a hip on a slope or on steps."""

    frame = Attachment("The frame.")
    terrain = Part(
        "terrain",
        "The ground.",
        default="terrain/flat",
        reads=(("ground_height", "height"),),
        sends=(("position", "position"), ("side_position", "side_position")),
    )
    ground_height = Input("m", "Height of the ground below the frame.", default=0)
    position = Output("m", "Position of the frame along the ground.")
    side_position = Output("m", "Position of the frame to the left.")
    place_height = Output("m", "Height of the frame, from the same zero as heights of the ground.")
    height = Output("m", "Height of the frame above the ground.")

    @staticmethod
    def output(p, u, x, y):
        y.height = y.place_height - u.ground_height

    @staticmethod
    def build(p, mj):
        place = mj.position_of(mj.attached("frame"), surface="terrain")
        mj.read("position", place, "sensordata", 0)
        mj.read("side_position", place, "sensordata", 1)
        mj.read("place_height", place, "sensordata", 2)
