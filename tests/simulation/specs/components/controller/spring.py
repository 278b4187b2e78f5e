from gaitsim.component import Component, Input, Output, Parameter


class Spring(Component):
    """A linear spring without a limit: stiff enough, it diverges in explicit steps."""

    stiffness = Parameter("N m/rad", "Torque per angle.", bounds=(0, 1e12))
    angle = Input("rad", "Angle from rest.")
    torque = Output("N m", "Torque towards rest.")

    @staticmethod
    def output(p, u, x, y):
        y.torque = -p.stiffness * u.angle
