from gaitsim.component import Component, Input, Output, Parameter, State


class Pid(Component):
    """Proportional, integral and derivative control of an angle by a torque."""

    proportional = Parameter("N m/rad", "Torque per angle.", bounds=(0, 1e6))
    integral = Parameter(
        "N m/(rad s)", "Torque per angle and time.", default=0, bounds=(0, 1e6), source="definition: PD control"
    )
    derivative = Parameter(
        "N m s/rad", "Torque per angular velocity.", default=0, bounds=(0, 1e6), source="definition: P control"
    )
    setpoint = Parameter("rad", "The angle to hold.", default=0, bounds=(-10, 10), source="definition: upright")
    limit = Parameter(
        "N m", "Largest torque of either sign.", default=1e6, bounds=(0, 1e6), source="definition: no limit"
    )
    angle = Input("rad", "Measured angle.")
    angular_velocity = Input("rad/s", "Measured angular velocity.")
    accumulated = State("rad s", "Integral of the error.")
    torque = Output("N m", "Torque that reduces the error.")

    @staticmethod
    def output(p, u, x, y):
        error = p.setpoint - u.angle
        wanted = p.proportional * error + p.integral * x.accumulated - p.derivative * u.angular_velocity
        y.torque = max(-p.limit, min(p.limit, wanted))

    @staticmethod
    def update(p, u, x, y, dt):
        x.accumulated = x.accumulated + (p.setpoint - u.angle) * dt
