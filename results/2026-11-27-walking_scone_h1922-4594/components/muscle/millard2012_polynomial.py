import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, Part, State, StepLimit

from ._hill import METABOLICS, PATH_LENGTH, PENNATE_PATH, PENNATION_ANGLE, STEP_MEASURE, look_ahead

# Constants of geijtenbeek2021, for lengths in l_opt, velocities in v_max and forces in F_max. Powers are written as
# products, which round identically in Python and in native code.
TENDON_SQUARE, TENDON_LINEAR = 260.972, 7.9706  # c_T1, c_T2
ACTIVE_CUBE, ACTIVE_SQUARE = 1.5, -2.75  # c_L1, c_L2
SHORTEST, LONGEST = 0.46899, 1.80528  # r_1, r_2: where f_l vanishes
CONCENTRIC, ECCENTRIC, MOST = 0.227, 0.110, 1.6  # c_V1, c_V2, F_vmax
PASSIVE_CUBE, PASSIVE_SQUARE = 1.08027, 1.27368  # c_P1, c_P2


def active_force(length):
    """f_l of the active fiber, between r_1 and r_2; never negative, which rounding of r_1 and r_2 would allow."""
    x = length - 1
    return max(0.0, ACTIVE_CUBE * (x * x * x) + ACTIVE_SQUARE * (x * x) + 1) if SHORTEST < length < LONGEST else 0.0


def passive_force(length):
    """f_PE of the passive fiber."""
    x = max(0.0, length - 1)
    return PASSIVE_CUBE * (x * x * x) + PASSIVE_SQUARE * (x * x)


def passive_energy(length):
    """Integral of f_PE over the length."""
    x = max(0.0, length - 1)
    return PASSIVE_CUBE * ((x * x) * (x * x)) / 4 + PASSIVE_SQUARE * (x * x * x) / 3


def tendon_force(strain):
    """f_T over the tendon's strain."""
    e = max(0.0, strain)
    return TENDON_SQUARE * (e * e) + TENDON_LINEAR * e


def tendon_stiffness(strain):
    """Slope of f_T over the strain."""
    return 2 * TENDON_SQUARE * strain + TENDON_LINEAR if strain > 0 else 0.0


def tendon_energy(strain):
    """Integral of f_T over the strain."""
    e = max(0.0, strain)
    return TENDON_SQUARE * (e * e * e) / 3 + TENDON_LINEAR * (e * e) / 2


def force_velocity(velocity):
    """f_v over the velocity in v_max."""
    if velocity <= -1:
        return 0.0
    if velocity < 0:
        return CONCENTRIC * (velocity + 1) / (CONCENTRIC - velocity)
    return (MOST * velocity + ECCENTRIC) / (ECCENTRIC + velocity)


def force_velocity_slope(velocity):
    """Slope of f_v."""
    if velocity <= -1:
        return 0.0
    if velocity < 0:
        return CONCENTRIC * (CONCENTRIC + 1) / (CONCENTRIC - velocity) ** 2
    return ECCENTRIC * (MOST - 1) / (ECCENTRIC + velocity) ** 2


def velocity_from_force(force, active, damping):
    """v at which active f_v(v) + damping v is the force: a root of a quadratic equation on either side of 0."""
    if force <= -damping:
        return force / damping
    if force < active:
        linear = CONCENTRIC * (active + damping) + force
        root = math.sqrt(linear * linear + 4 * damping * CONCENTRIC * (active - force))
        return 2 * CONCENTRIC * (force - active) / (linear + root)
    linear = force - MOST * active - damping * ECCENTRIC
    root = math.sqrt(linear * linear + 4 * damping * ECCENTRIC * (force - active))
    # The form of the root is chosen to avoid cancellation.
    return (linear + root) / (2 * damping) if linear > 0 else 2 * ECCENTRIC * (force - active) / (root - linear)


def velocity_after(velocity, strain, loss, cosine, beside, strength, damping):
    """Velocity at which the balance holds if the tendon has `strain` - `loss` v.

    Linearized about the last velocity, the tendon acts as an additional damper. The tendon stiffens with strain, so
    it pulls at least as hard as its linearization, and the iterates increase towards the solution.
    """
    for _ in range(20):
        before = strain - loss * velocity
        slope = tendon_stiffness(before) * loss / cosine
        force = tendon_force(before) / cosine + slope * velocity - beside
        after = velocity_from_force(force, strength, damping + slope)
        change = after - velocity
        velocity = after
        if abs(change) < 1e-6:
            break
    return velocity


class Millard2012Polynomial(Component):
    """The muscle of Millard et al. (2013) with polynomials for its curves, as Hyfydy has it (m2012fast).

    F_max (A f_l f_v + f_PE + beta v) cos(alpha) = F_max f_T, where l sin(alpha) is constant. The curves are near those
    of millard2012 and quicker to compute; f_v has its inverse in closed form. It starts in equilibrium, at rest.
    """

    max_isometric_force = Parameter("N", "F_max.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt.", bounds=(1e-3, 1))
    tendon_slack_length = Parameter("m", "l_slack.", bounds=(1e-3, 2))
    max_contraction_velocity = Parameter(
        "1/s", "v_max in optimal fiber lengths per second.", default=10, bounds=(1, 50), source="geijtenbeek2021"
    )
    pennation_angle = PENNATION_ANGLE
    damping = Parameter(
        "1", "beta: damping in F_max per v_max.", default=0.1, bounds=(0.02, 10), source="geijtenbeek2021"
    )
    min_fiber_length = Parameter(
        "1",
        "Smallest fiber length, in optimal lengths.",
        default=SHORTEST,
        bounds=(0.01, 0.9),
        source="geijtenbeek2021: where f_l vanishes",
    )

    largest_step = StepLimit("ms", STEP_MEASURE, 0.5)

    path = PENNATE_PATH
    activation_dynamics = Part(
        "activation",
        "From excitation to activation.",
        default="activation/two_constants",
        reads=(("activation_level", "activation"),),
        sends=(("excitation", "excitation"),),
    )
    metabolics = METABOLICS
    excitation = Input("1", "Sum of all stimulations.", sums=True)
    activation_level = Input("1", "Activation.")
    path_length = PATH_LENGTH
    path_velocity = Input("m/s", "Its lengthening velocity.")

    length = State("m", "Length of the fiber.")
    strength_before = State("1", "A f_l one step ago.")
    beside_before = State("1", "f_PE one step ago.")

    force = Output("N", "Force of the muscle-tendon unit.")
    normalized_force = Output("1", "Force in F_max.", usual=(0, 1.5), possible=(0, 10))
    activation = Output("1", "Activation A.")
    fiber_length = Output("m", "Length of the fiber.")
    normalized_fiber_length = Output(
        "1", "Length of the fiber in optimal lengths.", usual=(0.4, 1.6), possible=(0, 2.5)
    )
    fiber_velocity = Output("m/s", "Velocity of the fiber, shortening negative.")
    normalized_fiber_velocity = Output("1", "Velocity of the fiber in v_max.")
    fiber_force = Output("N", "Active force of the fiber, A F_max f_l f_v, along the fiber.")
    normalized_isometric_force = Output("1", "f_l: active force in F_max, at rest and full activation.")
    pennation = Output("rad", "alpha.")
    tendon_strain_now = Output("1", "Strain of the tendon; 0 while it is slack.")
    elastic_energy = Output("J", "Elastic energy in the tendon and the parallel element.")

    active_curve = Curve(of="active_force", over="length", span=(0.4, 1.9), doc="f_l over the length in l_opt.")
    velocity_curve = Curve(of="force_velocity", over="velocity", span=(-1.2, 1), doc="f_v over the velocity in v_max.")
    passive_curve = Curve(of="passive_force", over="length", span=(0.4, 1.9), doc="f_PE over the length in l_opt.")
    tendon_curve = Curve(of="tendon_force", over="strain", span=(-0.01, 0.06), doc="f_T over the strain.")

    @staticmethod
    def start(p, u, x):
        # At rest the residual of the force balance grows with the fiber length, so it has one root, found by bisection.
        width = p.optimal_fiber_length * math.sin(p.pennation_angle)
        low, high = p.min_fiber_length * p.optimal_fiber_length, max(u.path_length, p.optimal_fiber_length)
        for _ in range(60):
            middle = 0.5 * (low + high)
            along = math.sqrt(max(0.0, middle * middle - width * width))
            strain = (u.path_length - along - p.tendon_slack_length) / p.tendon_slack_length
            normalized = middle / p.optimal_fiber_length
            fiber = u.activation_level * active_force(normalized) + passive_force(normalized)
            if tendon_force(strain) * middle > fiber * along:
                low = middle
            else:
                high = middle
        x.length = 0.5 * (low + high)
        length = x.length / p.optimal_fiber_length
        x.strength_before = u.activation_level * active_force(length)
        x.beside_before = passive_force(length)

    @staticmethod
    def output(p, u, x, y):
        length = x.length / p.optimal_fiber_length
        sine = min(p.optimal_fiber_length * math.sin(p.pennation_angle) / x.length, 1.0)
        cosine = math.sqrt(1 - sine * sine)
        strain = max(0.0, (u.path_length - x.length * cosine - p.tendon_slack_length) / p.tendon_slack_length)
        y.activation = u.activation_level
        y.fiber_length = x.length
        y.normalized_fiber_length = length
        y.pennation = math.asin(sine)
        y.tendon_strain_now = strain
        y.normalized_force = tendon_force(strain)
        y.force = p.max_isometric_force * y.normalized_force
        in_tendon = p.tendon_slack_length * tendon_energy(strain)
        in_fiber = p.optimal_fiber_length * passive_energy(length)
        y.elastic_energy = p.max_isometric_force * (in_tendon + in_fiber)
        y.normalized_isometric_force = active_force(length)
        driving = y.normalized_force / cosine - passive_force(length)
        strength = u.activation_level * y.normalized_isometric_force
        velocity = velocity_from_force(driving, strength, p.damping)
        y.fiber_force = p.max_isometric_force * strength * force_velocity(velocity)
        y.normalized_fiber_velocity = velocity
        y.fiber_velocity = velocity * p.max_contraction_velocity * p.optimal_fiber_length

    @staticmethod
    def update(p, u, x, y, dt):
        # At low activation a fiber follows its tendon within less than a step. The force balance is therefore solved
        # at an instant within the step, to which the path and the force of the fiber are extrapolated linearly.
        cosine = math.cos(y.pennation)
        v_max = p.max_contraction_velocity * p.optimal_fiber_length
        strength = y.normalized_isometric_force * u.activation_level
        beside = passive_force(y.normalized_fiber_length)
        loss = v_max * dt / (cosine * p.tendon_slack_length)
        stiffness = tendon_stiffness(y.tendon_strain_now) / cosine
        slope = force_velocity_slope(y.normalized_fiber_velocity)
        ahead = look_ahead(stiffness * loss / (strength * slope + p.damping))
        longer = u.path_length + ahead * dt * u.path_velocity - x.length * cosine - p.tendon_slack_length
        velocity = velocity_after(
            y.normalized_fiber_velocity,
            longer / p.tendon_slack_length,
            ahead * loss,
            cosine,
            beside + ahead * (beside - x.beside_before),
            max(0.5 * strength, strength + ahead * (strength - x.strength_before)),
            p.damping,
        )
        x.strength_before, x.beside_before = strength, beside
        # A pennation of acos(0.1) at most, as OpenSim has it, or the shortest fiber that has active force.
        widest = math.sin(p.pennation_angle) / math.sqrt(0.99)
        shortest = max(p.min_fiber_length, widest) * p.optimal_fiber_length
        x.length = max(shortest, x.length + velocity * v_max * dt)
