from gaitsim.component import Component, Input, Output, Points


class Sites(Component):
    """A path of straight lines through points on segments."""

    points = Points("At least two points, from origin to insertion.")
    tension = Input("N", "Force along the path, positive in tension.", sums=True)
    length = Output("m", "Length of the path.")
    velocity = Output("m/s", "Lengthening velocity of the path.")

    @staticmethod
    def build(p, mj):
        tendon = mj.tendon(p.points)
        mj.read("length", tendon, "ten_length")
        mj.read("velocity", tendon, "ten_velocity")
        # MuJoCo's actuator force lengthens a tendon when positive; tension shortens it.
        mj.apply("tension", mj.motor(tendon), "ctrl", sign=-1)
