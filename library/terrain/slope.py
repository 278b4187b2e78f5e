from gaitsim.component import Component, Input, Output, Parameter


class Slope(Component):
    """Ground that rises forwards by one angle everywhere, through the world's origin; and maybe to the left."""

    angle = Parameter("deg", "By how much the ground rises forwards; below 0, it falls.", bounds=(-60, 60))
    across = Parameter(
        "deg",
        "By how much the ground rises to the left, about the way forwards along it.",
        default=0,
        bounds=(-60, 60),
        source="definition: a slope straight ahead",
    )
    position = Input("m", "Where along the ground.", default=0)
    height = Output("m", "Height of the ground above the slope itself.")
    slope = Output("rad", "By how much the ground rises forwards.")

    @staticmethod
    def output(p, u, x, y):
        y.height = 0.0
        y.slope = p.angle

    @staticmethod
    def build(p, mj):
        mj.ground(p.angle, across=p.across)
