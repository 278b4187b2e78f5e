import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, Part, State, StepLimit

from ._hill import METABOLICS, PATH_LENGTH, look_ahead


def force_length(length, width):
    """f_l = exp(ln(0.05) |(l - 1) / w|^3); 0.05 at l = 1 +- w."""
    offset = abs(length - 1) / width
    return math.exp(math.log(0.05) * offset * offset * offset)


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


def parallel_force(length, width):
    """F_PE / F_max = ((l - 1) / w)^2 for l > 1: a spring parallel to the contractile element."""
    return (max(0.0, length - 1) / width) ** 2


def buffer_force(length, width):
    """F_BE / F_max = ((l - (1 - w)) / (w / 2))^2 for l < 1 - w: keeps the contractile element from collapsing."""
    return (max(0.0, 1 - width - length) / (width / 2)) ** 2


def tendon_force(strain, strain_at_max):
    """F_SE / F_max = (eps / eps_ref)^2 for eps > 0."""
    return (max(0.0, strain) / strain_at_max) ** 2


def force_velocity(velocity, eccentric, curvature):
    """f_v and its slope; 0 below -1. `velocity_from_force` is the inverse over the whole range."""
    if velocity <= -1:
        return 0.0, 1 / (1 + curvature)
    if velocity <= 0:
        below = 1 - curvature * velocity
        return (1 + velocity) / below, (1 + curvature) / (below * below)
    if velocity <= 1:
        above = 7.56 * curvature * velocity + 1
        rise = (eccentric - 1) * (1 + 7.56 * curvature) / (above * above)
        return eccentric + (eccentric - 1) * (velocity - 1) / above, rise
    return eccentric + 100 * (velocity - 1), 100.0


def velocity_after(velocity, strain, loss, strength, buffer, eccentric, curvature):
    """Velocity at which the balance holds if the tendon has `strain` - `loss` v, in strains at F_max."""
    for _ in range(20):
        pull = max(0.0, strain - loss * velocity)
        force, slope = force_velocity(velocity, eccentric, curvature)
        step = (pull * pull + buffer - strength * force) / (2 * pull * loss + strength * slope)
        after = max(-1.0, velocity + step)
        # f_v has kinks at 0 and at 1: an iteration stops there first.
        if velocity * after < 0:
            after = 0.0
        elif (velocity - 1) * (after - 1) < 0:
            after = 1.0
        velocity = after
        if abs(step) < 1e-7:
            break
    return velocity


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
        "1", "Smallest fiber length, in optimal lengths.", default=0.05, bounds=(1e-3, 0.5), source="geyer2010"
    )

    longest_substep = Parameter(
        "ms",
        "Longer steps are divided into equal substeps of at most this; path and activation are extrapolated linearly.",
        default=1,
        bounds=(1e-3, 100),
        source="definition: halving it improves no case of largest_step",
    )

    largest_step = StepLimit(
        "ms",
        "Force within 6 % of F_max of that at 5 us at every instant, at 1 ms within 2.5 %, at 0.5 ms within 1.5 %: an "
        "isometric contraction and relaxation, stretches and releases at half v_max at A = 0.01 and 0.5, 0.3 F_max "
        "lifted; soleus, vasti, hip flexors. The remaining error is that of the first step after a jump of the "
        "excitation, and Euler's error of the lift.",
        2,
    )

    path = Part(
        "path",
        "Geometry from origin to insertion.",
        reads=(("path_length", "length"), ("path_velocity", "velocity")),
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
    path_velocity = Input("m/s", "Its lengthening velocity.")

    length = State("m", "Length of the contractile element, l_CE.")
    strength_before = State("1", "A f_l + F_PE one step or part of a step ago.")
    activation_before = State("1", "A one step ago.")

    force = Output("N", "Force of the muscle-tendon unit.")
    normalized_force = Output("1", "Force in F_max.", usual=(0, 1.5), possible=(0, 10))
    activation = Output("1", "Activation A.")
    fiber_length = Output("m", "l_CE.")
    normalized_fiber_length = Output("1", "l_CE in optimal lengths.", usual=(0.4, 1.6), possible=(0, 2.5))
    fiber_velocity = Output("m/s", "v_CE, shortening negative.")
    normalized_fiber_velocity = Output("1", "v_CE in v_max.")
    fiber_force = Output("N", "Active force of the contractile element, A F_max f_l f_v.")
    normalized_isometric_force = Output("1", "f_l: active force in F_max, at rest and full activation.")
    tendon_strain_now = Output("1", "Strain of the tendon, eps; 0 while it is slack.")
    tendon_energy = Output("J", "Elastic energy in the tendon, F_max l_slack eps^3 / (3 eps_ref^2).")
    elastic_energy = Output("J", "Elastic energy in the tendon, the parallel and the buffer element.")

    active_curve = Curve("force_length", "length", (0.2, 1.8), "f_l over the length in l_opt.")
    velocity_curve = Curve(
        "velocity_from_force",
        "ratio",
        (0, 1.6),
        "f_v over the velocity in v_max, shortening negative.",
        at={"eccentric": "eccentric_force"},
        inverse=True,
    )
    passive_curve = Curve("parallel_force", "length", (0.2, 1.8), "F_PE in F_max over the length in l_opt.")
    buffer_curve = Curve("buffer_force", "length", (0.1, 1), "F_BE in F_max over the length in l_opt.")
    tendon_curve = Curve(
        "tendon_force", "strain", (-0.01, 0.06), "F_SE in F_max over the strain.", at={"strain_at_max": "tendon_strain"}
    )

    @staticmethod
    def start(p, u, x):
        # At rest the residual of the force balance grows with the fiber length, so it has one root, found by bisection.
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
        length = x.length / p.optimal_fiber_length
        x.strength_before = u.activation_level * force_length(length, p.width) + parallel_force(length, p.width)
        x.activation_before = u.activation_level

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
        y.normalized_isometric_force = force_length(length, p.width)
        active = u.activation_level * y.normalized_isometric_force
        ratio = (y.normalized_force + buffer) / (active + parallel)
        y.fiber_force = p.max_isometric_force * active * ratio
        y.normalized_fiber_velocity = velocity_from_force(ratio, p.eccentric_force, p.curvature)
        y.fiber_velocity = y.normalized_fiber_velocity * p.max_contraction_velocity * p.optimal_fiber_length

    @staticmethod
    def update(p, u, x, y, dt):
        # At low activation a fiber follows its tendon within less than a step. The force balance is therefore solved
        # at an instant within the step, to which the path and the force of the fiber are extrapolated linearly.
        tendon = p.tendon_slack_length * p.tendon_strain
        v_max = p.max_contraction_velocity * p.optimal_fiber_length
        shortest = p.min_fiber_length * p.optimal_fiber_length
        parts = max(1, math.ceil(min(1000.0, dt / p.longest_substep) - 1e-9))
        h = dt / parts
        length, velocity = y.normalized_fiber_length, y.normalized_fiber_velocity
        path, strain, isometric = u.path_length, y.tendon_strain_now, y.normalized_isometric_force
        activation, rise = u.activation_level, (u.activation_level - x.activation_before) / parts
        for i in range(parts):
            if i > 0:
                path, activation = path + h * u.path_velocity, activation + rise
                length = x.length / p.optimal_fiber_length
                strain = max(0.0, (path - x.length - p.tendon_slack_length) / p.tendon_slack_length)
                isometric = force_length(length, p.width)
            parallel, buffer = parallel_force(length, p.width), buffer_force(length, p.width)
            strength = activation * isometric + parallel
            slope = force_velocity(min(1.0, velocity), p.eccentric_force, p.curvature)[1]
            loss = v_max * h / tendon
            ahead = look_ahead(2 * strain / p.tendon_strain * loss / (strength * slope))
            velocity = velocity_after(
                velocity,
                (path + ahead * h * u.path_velocity - x.length - p.tendon_slack_length) / tendon,
                ahead * loss,
                max(0.5 * strength, strength + ahead * (strength - x.strength_before)),
                buffer,
                p.eccentric_force,
                p.curvature,
            )
            x.strength_before = strength
            x.length = max(shortest, x.length + velocity * v_max * h)
        x.activation_before = u.activation_level
