from gaitsim.component import Component, Input, Output, Part


class Pair(Component):
    """A controller with a filter inside."""

    filter = Part(
        "controller",
        "What shapes the angle.",
        default="controller/spring",
        reads=(("filtered", "torque"),),
        sends=(("angle", "angel"),),
    )
    angle = Input("rad", "Angle of the joint.")
    filtered = Input("N m", "What the filter gives.")
    torque = Output("N m", "Torque.")

    @staticmethod
    def output(p, u, x, y):
        y.torque = u.filtered
