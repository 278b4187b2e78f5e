import math

from gaitsim.component import Attachment, Component, Input, Link, Output, Parameter, State


class Spring(Component):
    """Massless leg with a linear spring between the hip and a fixed foothold: the spring-loaded inverted pendulum.

    In flight it has the touchdown angle. It lands when its foot reaches the ground. In stance it pushes with
    k (l_0 - l) until it reaches its rest length again (Blickhan 1989; Geyer, Seyfarth & Blickhan 2006). An optional
    damper parallel to the spring subtracts c dl/dt; the leg then takes off where its force ends.
    Touchdown and take-off are events, located within the step.
    """

    hip = Attachment("The frame that the leg carries.")
    carrier = Link(
        "The planar joint that moves the hip.",
        reads=(
            ("x", "x"),
            ("z", "z"),
            ("forward_velocity", "forward_velocity"),
            ("upward_velocity", "upward_velocity"),
        ),
        sends=(("forward_force", "forward_force"), ("upward_force", "upward_force")),
    )
    ground = Parameter("m", "Height of the ground.", default=0, bounds=(-100, 100), source="definition: the origin")
    stiffness = Input("N/m", "Stiffness k of the spring.")
    rest_length = Input("m", "Rest length l_0.")
    touchdown_angle = Input(
        "rad", "Angle between leg and ground in flight; below 90 deg the foot is in front of the hip."
    )
    damping = Input("N s/m", "Damping c of the spring in stance.", default=0)
    hip_torque = Input("N m", "Torque of the hip that turns the standing foot backwards.", sums=True)
    x = Input("m", "Forward position of the hip.")
    z = Input("m", "Height of the hip.")
    forward_velocity = Input("m/s", "Rate of x.")
    upward_velocity = Input("m/s", "Rate of z.")
    opposite_touchdown = Input("s", "Time of the other leg's touchdown.", default=0)
    opposite_foot = Input("m", "Position of the other foot.", default=0)

    standing = State("1", "The leg stands: 1, or 0 in the air.")
    foot = State("m", "Position of the foot.")
    landed = State("s", "Time of the last touchdown.")
    contact = State("s", "Duration of the last stance.")
    stride = State("m", "Distance in front of the other foot at touchdown.")
    overlap = State("s", "Duration of double support at the end of the last stance.")

    length = Output("m", "Length of the leg; in the air the rest length.")
    velocity = Output("m/s", "Rate of the length; 0 in the air.")
    force = Output("N", "Force of the spring, away from the ground.")
    forward_force = Output("N", "Force on the hip, forwards.")
    upward_force = Output("N", "Force on the hip, upwards.")
    energy = Output("J", "Elastic energy of the spring.")
    in_stance = Output("1", "1 while the leg stands, else 0.")
    in_flight = Output("1", "1 while the leg is in the air, else 0.")
    ahead = Output("m", "Distance of the hip in front of the foot.")
    above = Output("m", "Height of the hip above the foot.")
    foot_place = Output("m", "Position of the foot in its present or last stance.")
    step_length = Output("m", "Distance in front of the other foot at the last touchdown.")
    touchdown_time = Output("s", "Time of the last touchdown.")
    contact_time = Output("s", "Duration of the last stance.")
    double_support = Output("s", "From the other leg's last touchdown to this leg's last take-off.")
    guard = Output("m", "Rises through 0 at touchdown and at take-off.")

    @staticmethod
    def output(p, u, x, y):
        y.in_stance = x.standing
        y.in_flight = 1.0 - x.standing
        y.touchdown_time = x.landed
        y.foot_place = x.foot
        y.step_length = x.stride
        y.contact_time = x.contact
        y.double_support = x.overlap
        reach = u.rest_length * math.cos(u.touchdown_angle)
        height = u.rest_length * math.sin(u.touchdown_angle)
        y.ahead = -reach
        y.above = height
        y.length = u.rest_length
        y.velocity = 0.0 * u.forward_velocity
        y.force = 0.0 * u.stiffness * y.length
        y.forward_force = 0.0 * y.force
        y.upward_force = 0.0 * y.force
        y.guard = p.ground + height - u.z
        if x.standing > 0.5:
            y.ahead = u.x - x.foot
            y.above = u.z - p.ground
            y.length = math.hypot(y.ahead, y.above)
            y.velocity = (y.ahead * u.forward_velocity + y.above * u.upward_velocity) / y.length
            y.force = u.stiffness * (u.rest_length - y.length) - u.damping * y.velocity
            along, across = y.force / y.length, u.hip_torque / y.length**2
            y.forward_force = along * y.ahead + across * y.above
            y.upward_force = along * y.above - across * y.ahead
            y.guard = y.length - u.rest_length
            if u.damping > 0.0:
                y.guard = y.guard + u.damping * y.velocity / u.stiffness
        y.energy = 0.5 * u.stiffness * (u.rest_length - y.length) ** 2

    @staticmethod
    def reset(p, u, x, y, t):
        if x.standing > 0.5:
            x.standing = 0.0
            x.contact = t - x.landed
            x.overlap = t - u.opposite_touchdown
        else:
            x.standing = 1.0
            x.foot = u.x - y.ahead
            x.stride = x.foot - u.opposite_foot
            x.landed = t

    @staticmethod
    def build(p, mj):
        hip = mj.attached("hip")
        mj.draw_line([hip, mj.moved(hip, forward=("ahead", -1), up=("above", -1))], radius=0.02)
        mj.draw_force(hip, up="upward_force", forward="forward_force")
