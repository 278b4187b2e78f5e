from gaitsim.component import Component, Input, Output


class GroundForce(Component):
    """Ground reaction force on one foot, summed over its contacts, in newtons and in body weights."""

    normal = Input("N", "Forces along the ground's normal.", sums=True)
    forward = Input("N", "Forces along the ground, forwards.", sums=True)
    left = Input("N", "Forces along the ground, to the left.", sums=True)
    weight = Output("N", "Weight of the whole model.")
    side = Output("1", "-1 for a foot of the left side, else 1.")
    total_normal = Output("N", "Force along the normal.")
    total_forward = Output("N", "Force forwards.")
    total_medial = Output("N", "Force towards the other foot: of a right foot, to the left.")
    load = Output("1", "Force along the normal in body weights.")
    propulsion = Output("1", "Force forwards in body weights; braking is negative.")
    medial_load = Output("1", "Force towards the other foot in body weights.")

    @staticmethod
    def output(p, u, x, y):
        y.total_normal = u.normal
        y.total_forward = u.forward
        y.total_medial = y.side * u.left
        y.load = y.total_normal / y.weight if y.weight > 0 else 0.0
        y.propulsion = y.total_forward / y.weight if y.weight > 0 else 0.0
        y.medial_load = y.total_medial / y.weight if y.weight > 0 else 0.0

    @staticmethod
    def build(p, mj):
        mj.read_weight("weight")
        mj.read_side("side")
