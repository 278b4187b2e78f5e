import math

from gaitsim.component import Component, Input, Output, Parameter, Part, State


def force_length(length, width):
    """f_l = exp(ln(0.05) |(l - 1) / w|^3); 0.05 at l = 1 +- w."""
    offset = abs(length - 1) / width
    return math.exp(math.log(0.05) * offset * offset * offset)


def velocity_from_force(ratio, eccentric, curvature):
    """Inverse force-velocity relation: normalized velocity (shortening < 0) for a force ratio f_v.

    Beyond the eccentric maximum it goes on with slope 0.01, as numbers need and nature does not.
    """
    if ratio <= 1:
        return (ratio - 1) / (1 + curvature * ratio)
    if ratio <= eccentric:
        rest = (ratio - eccentric) / (eccentric - 1)
        return (1 + rest) / (1 - 7.56 * curvature * rest)
    return 1 + 0.01 * (ratio - eccentric)


def parallel_force(length, width):
    """F_PE / F_max = ((l - 1) / w)^2 for l > 1: a spring beside the contractile element."""
    return (max(0.0, length - 1) / width) ** 2


def buffer_force(length, width):
    """F_BE / F_max = ((l - (1 - w)) / (w / 2))^2 for l < 1 - w: keeps the element from collapsing."""
    return (max(0.0, 1 - width - length) / (width / 2)) ** 2


def tendon_force(strain, strain_at_max):
    """F_SE / F_max = (eps / eps_ref)^2 for eps > 0."""
    return (max(0.0, strain) / strain_at_max) ** 2


class Geyer2010(Component):
    """Hill-type muscle-tendon unit with parallel and buffer elasticity (Geyer & Herr 2010).

    F = F_SE = F_CE + F_PE - F_BE, where F_PE works through the force-velocity relation as well:
    (A f_l + F_PE) f_v = F_SE + F_BE, from which l_CE is integrated. It starts in equilibrium, at rest.
    """

    max_isometric_force = Parameter("N", "F_max.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt.", bounds=(1e-3, 1))
    tendon_slack_length = Parameter("m", "l_slack.", bounds=(1e-3, 2))
    max_contraction_velocity = Parameter(
        "1/s", "v_max in optimal fiber lengths per second.", default=12, bounds=(1, 50), source="geyer2003"
    )
    tendon_strain = Parameter(
        "1", "eps_ref: strain of the tendon at F_max.", default=0.04, bounds=(1e-3, 1), source="geyer2010"
    )
    width = Parameter(
        "1", "w: half width of f_l in optimal lengths.", default=0.56, bounds=(0.1, 0.95), source="geyer2010"
    )
    eccentric_force = Parameter(
        "1", "N: f_v at the largest lengthening velocity.", default=1.5, bounds=(1.01, 3), source="geyer2010"
    )
    curvature = Parameter("1", "K: curvature of f_v.", default=5, bounds=(0.1, 20), source="geyer2010")
    min_fiber_length = Parameter(
        "1", "Floor of the fiber in optimal lengths.", default=0.05, bounds=(1e-3, 0.5), source="geyer2010"
    )

    path = Part(
        "path",
        "Geometry from origin to insertion.",
        reads=(("path_length", "length"),),
        sends=(("tension", "force"),),
    )
    activation_dynamics = Part(
        "activation",
        "From excitation to activation.",
        default="activation/first_order",
        reads=(("activation_level", "activation"),),
        sends=(("excitation", "excitation"),),
    )
    excitation = Input("1", "Sum of all stimulations.", sums=True)
    activation_level = Input("1", "Activation.")
    path_length = Input("m", "Length of the whole muscle-tendon unit.")

    length = State("m", "Length of the contractile element, l_CE.")

    force = Output("N", "Force of the muscle-tendon unit.")
    normalized_force = Output("1", "Force in F_max.")
    activation = Output("1", "Activation A.")
    fiber_length = Output("m", "l_CE.")
    normalized_fiber_length = Output("1", "l_CE in optimal lengths.")
    fiber_velocity = Output("m/s", "v_CE, shortening negative.")
    normalized_fiber_velocity = Output("1", "v_CE in v_max.")
    tendon_strain_now = Output("1", "Strain of the tendon, eps; 0 while it is slack.")
    tendon_energy = Output("J", "Elastic energy in the tendon, F_max l_slack eps^3 / (3 eps_ref^2).")
    elastic_energy = Output("J", "Elastic energy in the tendon, the parallel and the buffer element.")

    @staticmethod
    def start(p, u, x):
        # At rest, the longer the fiber, the less the tendon and the more it pulls back: one root.
        low, high = p.min_fiber_length * p.optimal_fiber_length, max(u.path_length, p.optimal_fiber_length)
        for _ in range(60):
            middle = 0.5 * (low + high)
            normalized = middle / p.optimal_fiber_length
            strain = (u.path_length - middle - p.tendon_slack_length) / p.tendon_slack_length
            fiber = u.activation_level * force_length(normalized, p.width) + parallel_force(normalized, p.width)
            if tendon_force(strain, p.tendon_strain) > fiber - buffer_force(normalized, p.width):
                low = middle
            else:
                high = middle
        x.length = 0.5 * (low + high)

    @staticmethod
    def output(p, u, x, y):
        length = x.length / p.optimal_fiber_length
        strain = max(0.0, (u.path_length - x.length - p.tendon_slack_length) / p.tendon_slack_length)
        parallel, buffer = parallel_force(length, p.width), buffer_force(length, p.width)
        y.activation = u.activation_level
        y.fiber_length = x.length
        y.normalized_fiber_length = length
        y.tendon_strain_now = strain
        y.normalized_force = tendon_force(strain, p.tendon_strain)
        y.force = p.max_isometric_force * y.normalized_force
        y.tendon_energy = y.force * strain * p.tendon_slack_length / 3
        stretch, squeeze = max(0.0, length - 1), max(0.0, 1 - p.width - length)
        beside = (parallel * stretch + buffer * squeeze) / 3
        y.elastic_energy = y.tendon_energy + p.max_isometric_force * p.optimal_fiber_length * beside
        ratio = (y.normalized_force + buffer) / (u.activation_level * force_length(length, p.width) + parallel)
        y.normalized_fiber_velocity = velocity_from_force(ratio, p.eccentric_force, p.curvature)
        y.fiber_velocity = y.normalized_fiber_velocity * p.max_contraction_velocity * p.optimal_fiber_length

    @staticmethod
    def update(p, u, x, y, dt):
        shortest = p.min_fiber_length * p.optimal_fiber_length
        x.length = max(shortest, x.length + y.fiber_velocity * dt)
