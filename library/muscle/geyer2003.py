import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, Part, State, StepLimit

from ._hill import METABOLICS, PATH_LENGTH, STEP_MEASURE


def force_length(length, width):
    """f_l = exp(ln(0.05) |(l - 1) / w|^3); 0.05 at l = 1 +- w."""
    return math.exp(math.log(0.05) * abs((length - 1) / width) ** 3)


def velocity_from_force(ratio, eccentric, curvature):
    """Inverse force-velocity relation: normalized velocity (shortening < 0) for a force ratio f_v.

    Beyond the eccentric maximum the inverse continues with slope 0.01, for numerical reasons only.
    """
    if ratio <= 1:
        return (ratio - 1) / (1 + curvature * ratio)
    if ratio <= eccentric:
        rest = (ratio - eccentric) / (eccentric - 1)
        return (1 + rest) / (1 - 7.56 * curvature * rest)
    return 1 + 0.01 * (ratio - eccentric)


class Geyer2003(Component):
    """Hill-type muscle-tendon unit: a contractile element in series with a quadratic tendon.

    F = F_max (eps / eps_ref)^2 = A F_max f_l f_v, with l_CE integrated from f_v's inverse. No
    parallel elasticity (Geyer et al. 2003). At the start the tendon is just taut.
    """

    max_isometric_force = Parameter("N", "F_max.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt.", bounds=(1e-3, 1))
    tendon_slack_length = Parameter("m", "l_rest: slack length of the tendon.", bounds=(1e-3, 2))
    max_contraction_velocity = Parameter(
        "1/s", "v_max in optimal fiber lengths per second.", default=12, bounds=(1, 50), source="geyer2003"
    )
    tendon_strain = Parameter(
        "1", "eps_ref: strain of the tendon at F_max.", default=0.04, bounds=(1e-3, 1), source="geyer2003"
    )
    width = Parameter("1", "w: half width of f_l in optimal lengths.", default=0.4, bounds=(0.1, 2), source="geyer2003")
    eccentric_force = Parameter(
        "1", "N: f_v at the largest lengthening velocity.", default=1.5, bounds=(1.01, 3), source="geyer2003"
    )
    curvature = Parameter("1", "K: curvature of f_v.", default=5, bounds=(0.1, 20), source="geyer2003")
    min_fiber_length = Parameter(
        "1", "Smallest fiber length, in optimal lengths.", default=0.05, bounds=(1e-3, 0.5), source="geyer2010"
    )

    largest_step = StepLimit("ms", STEP_MEASURE, 0.1)

    path = Part(
        "path",
        "Geometry from origin to insertion.",
        reads=(("path_length", "length"),),
        sends=(("tension", "force"),),
        gives=(("reference_length", "optimal_fiber_length + tendon_slack_length"),),
    )
    activation_dynamics = Part(
        "activation",
        "From excitation to activation.",
        default="activation/first_order",
        reads=(("activation_level", "activation"),),
        sends=(("excitation", "excitation"),),
    )
    metabolics = METABOLICS
    excitation = Input("1", "Sum of all stimulations.", sums=True)
    activation_level = Input("1", "Activation.")
    path_length = PATH_LENGTH
    hold = Input("1", "1 keeps the fiber at the length at which the tendon is just taut, as in flight.", default=0)

    length = State("m", "Length of the contractile element, l_CE.")

    force = Output("N", "Force of the muscle-tendon unit.")
    normalized_force = Output("1", "Force in F_max.", usual=(0, 1.5), possible=(0, 10))
    activation = Output("1", "Activation A.")
    fiber_length = Output("m", "l_CE.")
    normalized_fiber_length = Output("1", "l_CE in optimal lengths.", usual=(0.4, 1.6), possible=(0, 2.5))
    fiber_velocity = Output("m/s", "v_CE, shortening negative.")
    normalized_fiber_velocity = Output("1", "v_CE in v_max.")
    fiber_force = Output("N", "Active force of the contractile element, A F_max f_l f_v.")
    normalized_isometric_force = Output("1", "f_l: active force in F_max, at rest and full activation.")
    tendon_strain_now = Output("1", "Strain of the tendon, eps.")
    tendon_energy = Output("J", "Elastic energy in the tendon, F_max l_rest eps^3 / (3 eps_ref^2).")
    elastic_energy = Output("J", "All elastic energy: that of the tendon.")

    active_curve = Curve("force_length", "length", (0.4, 1.6), "f_l over the length in l_opt.")
    velocity_curve = Curve(
        "velocity_from_force",
        "ratio",
        (0, 1.6),
        "f_v over the velocity in v_max, shortening negative.",
        at={"eccentric": "eccentric_force"},
        inverse=True,
    )
    tendon_curve = Curve(
        "normalized_force",
        "path_length",
        (0.49, 0.52),
        "Tendon: force in F_max over the path's length, l_CE = 10 cm, l_rest = 40 cm.",
        at={"optimal_fiber_length": 0.1, "tendon_slack_length": 0.4, "length": 0.1, "activation_level": 1},
    )

    @staticmethod
    def start(p, u, x):
        x.length = u.path_length - p.tendon_slack_length

    @staticmethod
    def output(p, u, x, y):
        y.activation = u.activation_level
        y.fiber_length = x.length
        y.normalized_fiber_length = x.length / p.optimal_fiber_length
        strain = max(0.0, (u.path_length - x.length - p.tendon_slack_length) / p.tendon_slack_length)
        y.tendon_strain_now = strain
        y.normalized_force = (strain / p.tendon_strain) ** 2
        y.force = p.max_isometric_force * y.normalized_force
        y.tendon_energy = y.force * strain * p.tendon_slack_length / 3
        y.elastic_energy = y.tendon_energy
        y.normalized_isometric_force = force_length(y.normalized_fiber_length, p.width)
        y.fiber_force = y.force
        isometric = u.activation_level * y.normalized_isometric_force
        ratio = y.normalized_force / isometric
        y.normalized_fiber_velocity = velocity_from_force(ratio, p.eccentric_force, p.curvature)
        v_max = p.max_contraction_velocity * p.optimal_fiber_length
        y.fiber_velocity = y.normalized_fiber_velocity * v_max

    @staticmethod
    def update(p, u, x, y, dt):
        if u.hold > 0.5:
            x.length = u.path_length - p.tendon_slack_length
        else:
            shortest = p.min_fiber_length * p.optimal_fiber_length
            x.length = max(shortest, x.length + y.fiber_velocity * dt)
