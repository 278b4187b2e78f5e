from gaitsim.component import Component, Input, Output, Parameter, State


class Side(Component):
    """On which side of the vertical an angle is; it breaks beyond a limit."""

    limit = Parameter("rad", "Below this angle it breaks.", default=-100)
    angle = Input("rad", "An angle.")
    side = State(levels=("left", "right"), doc="The side.")
    samples = State("rad", "The last angles.", size=4)
    turned = Output("deg", "The angle, with a unit that is not SI's.")

    @staticmethod
    def output(p, u, x, y):
        y.turned = u.angle
        if u.angle < p.limit:
            raise ValueError("it broke")

    @staticmethod
    def update(p, u, x, y, dt):
        x.side = 1 if u.angle > 0.0 else 0
        x.samples[0] = u.angle
