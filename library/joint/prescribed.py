import math

from gaitsim.component import Attachment, Component, Input, Option, Output, Parameter, Refused, Series, State


def between(before, here, after, beyond, share):
    """A smooth curve between the second and the third of four equidistant points (Catmull & Rom)."""
    square, cube = 2 * before - 5 * here + 4 * after - beyond, 3 * (here - after) + beyond - before
    return here + 0.5 * share * (after - before + share * (square + share * cube))


class Prescribed(Component):
    """A hinge that follows a recorded cycle regardless of moments: prescribed kinematics with simulated muscles.

    The recorded curve covers 0 to 100 % of the cycle, which lasts one period and repeats. The angle is interpolated
    smoothly between its points. Moments of muscles are reported but do not move the joint. A drive with an armature
    far above any segment's inertia turns the hinge so that it is on the curve at the end of each step.
    """

    parent = Attachment("The frame that holds the hinge.")
    child = Attachment("The frame that turns.")
    motion = Series("deg", "Recorded angle over the cycle.", size=101)
    period = Parameter("s", "Duration of a cycle.", bounds=(0.01, 1e3))
    first_phase = Parameter("1", "Phase at the start.", default=0, bounds=(0, 1), source="definition: the cycle begins")
    grows = Option(
        "Direction in which a hanging child turns as the angle increases.", choices=("backwards", "forwards")
    )
    neutral = Parameter(
        "deg",
        "Angle at which the two frames are aligned.",
        default=0,
        bounds=(-360, 360),
        source="definition: a choice",
    )
    zero = Parameter("deg", "Angle at which the curve is 0.", default=0, bounds=(-360, 360), source="definition: as is")
    sign = Parameter(
        "1",
        "1 if the angle increases with the curve, -1 if it decreases.",
        default=1,
        bounds=(-1, 1),
        source="definition: as is",
        whole=True,
    )
    armature = Parameter(
        "kg m^2", "Inertia of the drive.", default=1e7, bounds=(1, 1e12), source="definition: beyond any segment's"
    )
    moment = Input(
        "N m", "Moment of the muscles in the direction of increasing angle; it does not move the joint.", sums=True
    )

    steps = State("1", "Steps since the start.")
    step = State("s", "Duration of a step; 0 before the first.")
    coming = State("rad", "Angle at the end of this step.")

    angle = Output("rad", "Angle.")
    angular_velocity = Output("rad/s", "Rate of the angle.")
    phase = Output("1", "Phase of the cycle, from 0 up to but not including 1.")
    muscle_moment = Output("N m", "Sum of the moments of muscles.")
    drive = Output("N m", "Moment of the drive.")

    @staticmethod
    def output(p, u, x, y):
        y.phase = (p.first_phase + x.steps * x.step / p.period) % 1
        y.muscle_moment = u.moment
        y.drive = 0.0 * u.moment
        if x.step > 0:
            y.drive = p.armature * ((x.coming - y.angle) / x.step - y.angular_velocity) / x.step

    @staticmethod
    def update(p, u, x, y, dt):
        x.steps = x.steps + 1
        x.step = dt
        place = 100 * ((p.first_phase + (x.steps + 1) * dt / p.period) % 1)
        i = int(min(100.0, max(0.0, place)))
        before, here, after, beyond = (
            p.motion[(i - 1) % 100],
            p.motion[i % 100],
            p.motion[(i + 1) % 100],
            p.motion[(i + 2) % 100],
        )
        x.coming = p.zero + p.sign * between(before, here, after, beyond, place - math.floor(place))

    @staticmethod
    def build(p, mj):
        gap = abs(p.motion[100] - p.motion[0])
        if gap > 0.05 * (max(p.motion) - min(p.motion)):
            rule = "a cycle must end at the value at which it starts"
            raise Refused(f"motion ends {math.degrees(gap):.3g} deg from its start; {rule}")
        mj.agree(
            "period", p.period, "s", "joints that follow one recorded walk repeat together, so write the same value"
        )
        joint = mj.hinge(axis=(0, 1 if p.grows == "backwards" else -1, 0), neutral=p.neutral, armature=p.armature)
        place = 100 * (p.first_phase % 1)
        i = int(place)
        points = [p.motion[j % 100] for j in (i - 1, i, i + 1, i + 2)]
        rate = between(*points, place - i + 1e-6) - between(*points, place - i)
        mj.begins_at(joint, p.zero + p.sign * between(*points, place - i), p.sign * rate * 1e8 / p.period)
        mj.read("angle", joint, "qpos")
        mj.read("angular_velocity", joint, "qvel")
        mj.apply("drive", joint, "qfrc_applied")
