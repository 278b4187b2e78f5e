from gaitsim.component import Component, Input, Output, Parameter, State


class LegThrust(Component):
    """Lengthens the spring of a leg at its greatest compression, and shortens it again in the air (Raibert 1986).

    The spring in the leg of Raibert's machines stands on an actuator, which moves one end of it at the bottom of each
    hop: k is held, l_0 becomes l_0 + d. The work of the thrust is what the energy of the spring gains, k d (c + d/2)
    at a compression c. It is an event, located within the step.
    """

    length = Parameter("m", "l_0: rest length of the leg without thrust.", bounds=(1e-3, 10))
    thrust = Input("m", "d: by how much the spring is lengthened.")
    stiffness = Input("N/m", "k of the spring, for the work.")
    leg_length = Input("m", "Length of the leg.")
    leg_velocity = Input("m/s", "Rate of the length; 0 in the air.")
    in_stance = Input("1", "1 while the leg stands, else 0.")

    extended = State("m", "By how much the spring is lengthened now.")
    thrusting = State("1", "1 from the greatest compression to the end of stance, else 0.")
    done = State("J", "Work of all thrusts.")

    rest_length = Output("m", "Rest length of the leg.")
    work = Output("J", "Work of all thrusts so far.")
    guard = Output("m/s", "Rises through 0 at the greatest compression.")

    @staticmethod
    def output(p, u, x, y):
        y.rest_length = p.length + x.extended
        y.work = x.done
        compressed = u.in_stance > 0.5 and x.thrusting < 0.5
        y.guard = u.leg_velocity if compressed else 0.0 * u.leg_velocity

    @staticmethod
    def reset(p, u, x, y, t):
        x.done = x.done + u.stiffness * u.thrust * (p.length - u.leg_length + 0.5 * u.thrust)
        x.extended = u.thrust
        x.thrusting = 1.0

    @staticmethod
    def update(p, u, x, y, dt):
        if u.in_stance < 0.5:
            x.extended = 0.0
            x.thrusting = 0.0
