from gaitsim.component import Component, Input, Output, Parameter


def whole(number):
    """The largest whole number not above x."""
    return number - number % 1


class Steps(Component):
    """Ground at height 0 up to a first edge, then steps of equal height and depth, level or on a slope.

    Positions and heights are along the slope and its normal. A step is a jump of the height. Contacts with
    their own force law ignore the riser: a point that slides across an edge is below the upper ground at
    once. MuJoCo's contact collides with the riser.
    """

    first = Parameter("m", "Position of the first edge.", bounds=(-100, 1000))
    rise = Parameter("m", "Height of a step; negative for steps down.", bounds=(-2, 2))
    run = Parameter(
        "m", "Depth of a step, from edge to edge.", default=1, bounds=(0.01, 1000), source="definition: a choice"
    )
    count = Parameter("1", "Number of steps.", default=1, bounds=(1, 100), source="definition: one step", whole=True)
    angle = Parameter(
        "deg",
        "Slope of the ground in the forward direction between edges; negative for downhill.",
        default=0,
        bounds=(-60, 60),
        source="definition: level ground",
    )
    position = Input("m", "Position along the ground.", default=0)
    side_position = Input("m", "Position to the left.", default=0)
    height = Output("m", "Height of the ground there.")
    slope = Output("rad", "Slope of the ground in the forward direction.")
    gradient = Output("1", "How much the height grows with the position; always 0.")
    side_gradient = Output("1", "How much the height grows to the left; always 0.")

    @staticmethod
    def output(p, u, x, y):
        climbed = whole((u.position - p.first) / p.run) + 1
        y.height = p.rise * min(p.count, max(0.0, climbed))
        y.slope = p.angle
        y.gradient = 0.0
        y.side_gradient = 0.0

    @staticmethod
    def build(p, mj):
        mj.ground(p.angle, edges=[(p.first + i * p.run, (i + 1) * p.rise) for i in range(int(p.count))])
