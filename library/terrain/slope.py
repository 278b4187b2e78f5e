from gaitsim.component import Component, Input, Output, Parameter


class Slope(Component):
    """Ground of constant slope through the world's origin, forwards and optionally to the left."""

    angle = Parameter("deg", "Slope of the ground in the forward direction; negative for downhill.", bounds=(-60, 60))
    across = Parameter(
        "deg",
        "Slope of the ground to the left, about its forward direction.",
        default=0,
        bounds=(-60, 60),
        source="definition: a slope straight ahead",
    )
    position = Input("m", "Position along the ground.", default=0)
    side_position = Input("m", "Position to the left.", default=0)
    height = Output("m", "Height of the ground above the slope itself.")
    slope = Output("rad", "Slope of the ground in the forward direction.")
    gradient = Output("1", "How much the height grows with the position; always 0.")
    side_gradient = Output("1", "How much the height grows to the left; always 0.")

    @staticmethod
    def output(p, u, x, y):
        y.height = 0.0
        y.slope = p.angle
        y.gradient = 0.0
        y.side_gradient = 0.0

    @staticmethod
    def build(p, mj):
        mj.ground(p.angle, across=p.across)
