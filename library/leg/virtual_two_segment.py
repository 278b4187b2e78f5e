import math

from gaitsim.component import Attachment, Component, Curve, Input, Output, Parameter


class VirtualTwoSegment(Component):
    """A massless leg of two equal segments between the hip and the ground below it.

    It is a force without a body. In flight it has its landing length; in stance it spans from
    the ground to the hip. phi = 2 asin(l / (2 l_s)); F = M / sqrt(l_s^2 - l^2 / 4), where M is
    the knee's extending moment (Geyer et al. 2003).
    """

    hip = Attachment("The frame that the leg carries.")
    ground = Attachment("The frame on which the leg stands.")
    segment_length = Parameter("m", "Length l_s of thigh and shank.", bounds=(0.01, 2))
    landing_length = Parameter("m", "Leg length in flight; touchdown and take-off happen there.", bounds=(0.01, 4))
    knee_moment = Input("N m", "Moment that extends the knee.", sums=True)
    length = Output("m", "Distance from the ground to the hip.")
    velocity = Output("m/s", "Rate of that distance.")
    knee_angle = Output("rad", "Inner angle of the knee; 180 deg is straight.")
    knee_velocity = Output("rad/s", "Rate of the knee angle; 0 in flight.")
    span = Output("m", "Distance from the foot to the hip; in flight, the landing length.")
    knee_offset = Output("m", "Distance of the knee from the line between hip and foot.")
    in_stance = Output("1", "1 while the leg stands, else 0.")
    in_flight = Output("1", "1 while the leg is in the air, else 0.")
    force = Output("N", "Force of the leg on the hip, away from the ground.")

    bending = Curve(
        "knee_angle",
        "length",
        (0.5, 1.05),
        "Knee angle over length.",
        at={"segment_length": 0.5, "landing_length": 0.99},
    )
    bearing = Curve(
        "force",
        "length",
        (0.6, 1.05),
        "Force over length at a knee moment of 100 N m.",
        at={"segment_length": 0.5, "landing_length": 0.99, "knee_moment": 100},
    )

    @staticmethod
    def output(p, u, x, y):
        standing = y.length < p.landing_length
        length = y.length if standing else p.landing_length
        half_base = math.sqrt(p.segment_length**2 - length**2 / 4)
        y.span = length
        y.knee_offset = half_base
        y.in_stance = 1.0 if standing else 0.0
        y.in_flight = 1.0 - y.in_stance
        y.knee_angle = 2 * math.asin(length / (2 * p.segment_length))
        y.knee_velocity = y.in_stance * y.velocity / half_base
        y.force = y.in_stance * u.knee_moment / half_base

    @staticmethod
    def build(p, mj):
        tendon = mj.tendon_between("ground", "hip")
        mj.read("length", tendon, "ten_length")
        mj.read("velocity", tendon, "ten_velocity")
        mj.apply("force", mj.motor(tendon), "ctrl")
        hip = mj.attached("hip")
        knee = mj.moved(hip, forward=("knee_offset", 1), up=("span", -0.5))
        foot = mj.moved(hip, up=("span", -1))
        mj.draw_line([hip, knee, foot], radius=0.03)
        mj.draw_force(mj.attached("ground"), up="force")
