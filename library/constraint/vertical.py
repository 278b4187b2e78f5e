from gaitsim.component import Attachment, Component, Output, Parameter


class Vertical(Component):
    """Constraint that keeps one frame vertically below (or above) another in the sagittal plane.

    Points at equal distance from two places lie on the plane half way between these. Two tendons run
    from the point to a place in front of the line and to a place equally far behind it. One equality
    constraint keeps their lengths equal. It adds one row to the solver, and no body or mass.
    """

    line = Attachment("The frame through which the vertical runs.")
    point = Attachment("The frame that is kept on the vertical.")
    distance = Parameter(
        "m",
        "Distance of the two places in front of and behind the line.",
        default=1,
        bounds=(0.1, 1000),
        source="definition: about a leg's length, to limit rounding errors",
    )
    time_constant = Parameter(
        "s",
        "Time constant with which a deviation decays; MuJoCo takes at least two steps.",
        default=0.001,
        bounds=(1e-6, 1),
        source="definition: fast compared with a hop",
    )
    impedance = Parameter(
        "1",
        "Impedance d of MuJoCo's constraint.",
        default=0.9999,
        bounds=(0.5, 0.9999),
        source="definition: MuJoCo's largest",
    )
    moved_mass = Parameter(
        "kg",
        "Effective mass of the point; used for the energy of a deviation only.",
        default=1,
        bounds=(1e-3, 1000),
        source="definition: about a shank's mass",
    )
    ahead = Output("m", "Distance of the point from the place in front.")
    behind = Output("m", "Distance of the point from the place behind.")
    deviation = Output("m", "Distance of the point in front of the vertical.")
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
