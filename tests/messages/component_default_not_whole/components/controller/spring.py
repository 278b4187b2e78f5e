import math

from gaitsim.component import Component, Input, Output, Parameter, State


class Spring(Component):
    """A torsional spring that remembers its angle."""

    stiffness = Parameter("N m/rad", "Torque per angle.", default=2.5, bounds=(0, 100), whole=True)
    angle = Input("rad", "Angle of the joint.")
    before = State("rad", "Angle one step ago.")
    torque = Output("N m", "Torque towards zero.")

    @staticmethod
    def start(p, u, x):
        x.before = u.angle

    @staticmethod
    def output(p, u, x, y):
        y.torque = -p.stiffness * math.sin(u.angle)

    @staticmethod
    def update(p, u, x, y, dt):
        x.before = u.angle
