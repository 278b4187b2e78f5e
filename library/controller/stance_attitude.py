from gaitsim.component import Component, Input, Output, Parameter


class StanceAttitude(Component):
    """Holds the attitude of a hopper's body by the torque of the hip while the leg stands (Raibert 1986).

    M = -k_p (phi - phi_d) - k_d phi' leans the body; the same moment with the other sign turns the leg. In the air
    there is none, as a leg without mass has nothing to turn against.
    """

    proportional = Parameter("N m/rad", "k_p: moment per angle.", bounds=(0, 1e6))
    derivative = Parameter("N m s/rad", "k_d: moment per angular velocity.", bounds=(0, 1e6))
    setpoint = Input("rad", "phi_d: the pitch that is asked for.", default=0)
    pitch = Input("rad", "phi: how far the body leans forwards.")
    pitch_velocity = Input("rad/s", "Rate of the pitch.")
    in_stance = Input("1", "1 while the leg stands, else 0.")
    moment = Output("N m", "Moment that leans the body forwards.")
    hip_torque = Output("N m", "The same on the leg: turns the standing foot backwards.")

    @staticmethod
    def output(p, u, x, y):
        wanted = -p.proportional * (u.pitch - u.setpoint) - p.derivative * u.pitch_velocity
        y.moment = wanted if u.in_stance > 0.5 else 0.0 * wanted
        y.hip_torque = -y.moment
