from gaitsim.component import Component, Input, Output, Parameter, Points, Refused


class Wrapped(Component):
    """A path through points that wraps around a cylinder perpendicular to the sagittal plane, such as the knee.

    Where the straight line would cut the cylinder or pass it on the side opposite to `side`, the path
    wraps around it. Its moment arm then is the radius and cannot change sign.
    """

    origin = Points("Points before the cylinder, from the origin on.")
    insertion = Points("Points after the cylinder, up to the insertion.")
    center = Points("One point on the cylinder's axis.")
    side = Points("One point outside the cylinder, on the side where the path runs.")
    radius = Parameter("m", "Radius of the cylinder.", bounds=(1e-3, 1))
    tension = Input("N", "Force along the path, positive in tension.", sums=True)
    length = Output("m", "Length of the path.")
    velocity = Output("m/s", "Lengthening velocity of the path.")

    @staticmethod
    def build(p, mj):
        if len(p.center) != 1 or len(p.side) != 1:
            raise Refused("center and side are lists of one point each; remove the others")
        cylinder = mj.cylinder(p.center[0], p.radius, side=p.side[0])
        tendon = mj.tendon([*p.origin, cylinder, *p.insertion])
        mj.read("length", tendon, "ten_length")
        mj.read("velocity", tendon, "ten_velocity")
        # MuJoCo's actuator force lengthens a tendon when positive; tension shortens it.
        mj.apply("tension", mj.motor(tendon), "ctrl", sign=-1)
