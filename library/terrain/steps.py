from gaitsim.component import Component, Input, Output, Parameter


def whole(number):
    """The largest whole number that is not larger."""
    return number - number % 1


class Steps(Component):
    """Ground at height 0 up to a first edge, then steps of one height and depth; level, or all of it on a slope.

    Positions and heights are along the slope and its normal. A step is a jump of the height. Contacts with a
    force of their own do not feel the riser: a point that slides across an edge is below the upper ground at
    once. MuJoCo's contact does feel it.
    """

    first = Parameter("m", "Where the first edge is.", bounds=(-100, 1000))
    rise = Parameter("m", "Height of a step; below 0, it goes down.", bounds=(-2, 2))
    run = Parameter(
        "m", "Depth of a step, from edge to edge.", default=1, bounds=(0.01, 1000), source="definition: a choice"
    )
    count = Parameter("1", "Number of steps.", default=1, bounds=(1, 100), source="definition: one step")
    angle = Parameter(
        "deg",
        "By how much the ground rises forwards between edges; below 0, it falls.",
        default=0,
        bounds=(-60, 60),
        source="definition: level ground",
    )
    position = Input("m", "Where along the ground.", default=0)
    height = Output("m", "Height of the ground there.")
    slope = Output("rad", "By how much the ground rises forwards.")

    @staticmethod
    def output(p, u, x, y):
        climbed = whole((u.position - p.first) / p.run) + 1
        y.height = p.rise * min(whole(p.count), max(0.0, climbed))
        y.slope = p.angle

    @staticmethod
    def build(p, mj):
        mj.ground(p.angle, edges=[(p.first + i * p.run, (i + 1) * p.rise) for i in range(int(p.count))])
