from gaitsim.component import Component, Input, Output


class Flat(Component):
    """Level ground at height 0."""

    position = Input("m", "Position along the ground.", default=0)
    side_position = Input("m", "Position to the left.", default=0)
    height = Output("m", "Height of the ground there.")
    slope = Output("rad", "Slope of the ground in the forward direction.")
    gradient = Output("1", "How much the height grows with the position; always 0.")
    side_gradient = Output("1", "How much the height grows to the left; always 0.")

    @staticmethod
    def output(p, u, x, y):
        y.height = 0.0
        y.slope = 0.0
        y.gradient = 0.0
        y.side_gradient = 0.0

    @staticmethod
    def build(p, mj):
        mj.ground()
