from gaitsim.component import Attachment, Component, Input, Output, Part


class Clearance(Component):
    """How high a place is above the ground, along the ground's normal: of a hip on a slope or on steps, say."""

    frame = Attachment("The place.")
    terrain = Part(
        "terrain",
        "The ground.",
        default="terrain/flat",
        reads=(("ground_height", "height"),),
        sends=(("position", "position"),),
    )
    ground_height = Input("m", "Height of the ground where the place is.", default=0)
    position = Output("m", "Where the place is along the ground.")
    place_height = Output("m", "Height of the place, from where heights of the ground are counted.")
    height = Output("m", "Height of the place above the ground.")

    @staticmethod
    def output(p, u, x, y):
        y.height = y.place_height - u.ground_height

    @staticmethod
    def build(p, mj):
        place = mj.position_of(mj.attached("frame"), surface="terrain")
        mj.read("position", place, "sensordata", 0)
        mj.read("place_height", place, "sensordata", 2)
