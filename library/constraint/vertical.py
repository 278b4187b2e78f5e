from gaitsim.component import Attachment, Component, Output, Parameter


class Vertical(Component):
    """Keeps one frame straight below (or above) another in the sagittal plane: a restrictor.

    A point has the same distance from two places exactly if it lies on the plane half way between
    them. So two tendons run from the point to a place in front of the line and to one as far
    behind it, and one equality keeps them equally long. That adds one row to the solver, no body and no mass.
    """

    line = Attachment("The frame that the vertical runs through.")
    point = Attachment("The frame that is kept on the vertical.")
    distance = Parameter(
        "m",
        "How far in front and behind the two places are.",
        default=1,
        bounds=(0.1, 1000),
        source="definition: of the order of a leg, so that no digits are lost",
    )
    time_constant = Parameter(
        "s",
        "How fast a deviation is closed; MuJoCo takes at least two steps.",
        default=0.001,
        bounds=(1e-6, 1),
        source="definition: fast compared with a hop",
    )
    impedance = Parameter(
        "1", "d of MuJoCo's constraint.", default=0.9999, bounds=(0.5, 0.9999), source="definition: MuJoCo's largest"
    )
    moved_mass = Parameter(
        "kg",
        "Mass that the point moves with, for the energy of a deviation only.",
        default=1,
        bounds=(1e-3, 1000),
        source="definition: of the order of a shank",
    )
    ahead = Output("m", "Distance of the point from the place in front.")
    behind = Output("m", "Distance of the point from the place behind.")
    deviation = Output("m", "How far in front of the vertical the point is.")
    energy = Output("J", "Elastic energy of the deviation, m (x / T)^2 / 2.")

    @staticmethod
    def output(p, u, x, y):
        y.deviation = (y.behind - y.ahead) * (y.behind + y.ahead) / (4 * p.distance)
        y.energy = 0.5 * p.moved_mass * (y.deviation / p.time_constant) ** 2

    @staticmethod
    def build(p, mj):
        point = mj.attached("point")
        ahead = mj.tendon([mj.attached("line", (p.distance, 0, 0)), point], "ahead")
        behind = mj.tendon([mj.attached("line", (-p.distance, 0, 0)), point], "behind")
        mj.equal_lengths(ahead, behind, p.time_constant, p.impedance)
        mj.read("ahead", ahead, "ten_length")
        mj.read("behind", behind, "ten_length")
