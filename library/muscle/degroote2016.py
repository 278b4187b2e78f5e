import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, Part, State, StepLimit

from ._degroote2016 import D_1, D_2, D_3, D_4, active_force, force_velocity, passive_energy, passive_force
from ._hill import METABOLICS, PATH_LENGTH, PENNATE_PATH, PENNATION_ANGLE, STEP_MEASURE, look_ahead

SLOWEST, FASTEST = force_velocity(-1), force_velocity(1)


def velocity_from_force(ratio):
    """Inverse of f_v. Beyond v_max the inverse continues with slope 0.01, for numerical reasons only."""
    inside = min(FASTEST, max(SLOWEST, ratio))
    return (math.sinh((inside - D_4) / D_1) - D_3) / D_2 + 0.01 * (ratio - inside)


def tendon_stiffness(strain_at_max):
    """k_T of f_T = 0.2 exp(k_T (l_T - 1)) - 0.2, which is 1 at the strain given."""
    return math.log(6) / strain_at_max


def tendon_force(strain, stiffness):
    """f_T: exponential; unlike the published curve it is never negative."""
    return 0.2 * (math.exp(stiffness * max(0.0, strain)) - 1)


def force_and_slope(velocity):
    """f_v and its slope. `velocity_from_force` is the inverse over the whole range."""
    inside = min(1.0, max(-1.0, velocity))
    root = D_2 * inside + D_3
    slope = D_1 * D_2 / math.sqrt(root * root + 1) if velocity == inside else 100.0
    return force_velocity(inside) + 100 * (velocity - inside), slope


def velocity_after(velocity, strain, loss, stiffness, cosine, beside, strength):
    """Velocity at which the balance holds if the tendon has `strain` - `loss` v."""
    for _ in range(20):
        pull = tendon_force(strain - loss * velocity, stiffness)
        yielding = stiffness * (pull + 0.2) * loss if pull > 0 else 0.0
        force, slope = force_and_slope(velocity)
        step = (pull / cosine - beside - strength * force) / (yielding / cosine + strength * slope)
        after = velocity + step
        # f_v has kinks at -1 and at 1: an iteration stops there first.
        if (velocity + 1) * (after + 1) < 0:
            after = -1.0
        elif (velocity - 1) * (after - 1) < 0:
            after = 1.0
        velocity = after
        if abs(step) < 1e-7:
            break
    return velocity


class DeGroote2016(Component):
    """Hill-type muscle-tendon unit with an elastic tendon, a pennate fiber and smooth curves (De Groote et al. 2016).

    F_max (A f_l f_v + f_PE) cos(alpha) = F_max f_T, where l sin(alpha) is constant. It starts in
    equilibrium, at rest.
    """

    max_isometric_force = Parameter("N", "F_max.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt.", bounds=(1e-3, 1))
    tendon_slack_length = Parameter("m", "l_slack.", bounds=(1e-3, 2))
    max_contraction_velocity = Parameter(
        "1/s", "v_max in optimal fiber lengths per second.", default=10, bounds=(1, 50), source="degroote2016"
    )
    pennation_angle = PENNATION_ANGLE
    tendon_strain = Parameter(
        "1", "Strain of the tendon at F_max.", default=0.049, bounds=(1e-3, 1), source="dembia2020: OpenSim's model"
    )
    min_fiber_length = Parameter(
        "1", "Smallest fiber length, in optimal lengths.", default=0.2, bounds=(0.01, 0.9), source="degroote2016: f_PE"
    )

    largest_step = StepLimit("ms", STEP_MEASURE, 0.5)

    path = PENNATE_PATH
    activation_dynamics = Part(
        "activation",
        "From excitation to activation.",
        default="activation/degroote2016",
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

    active_curve = Curve(of="active_force", over="length", span=(0.2, 1.8), doc="f_l over the length in l_opt.")
    velocity_curve = Curve(of="force_velocity", over="velocity", span=(-1, 1), doc="f_v over the velocity in v_max.")
    passive_curve = Curve(of="passive_force", over="length", span=(0.2, 1.8), doc="f_PE over the length in l_opt.")
    tendon_curve = Curve(
        of="tendon_force", over="strain", span=(-0.01, 0.06), doc="f_T over the strain.", at={"stiffness": 36.5665}
    )

    @staticmethod
    def start(p, u, x):
        # At rest the residual of the force balance grows with the fiber length, so it has one root, found by bisection.
        width = p.optimal_fiber_length * math.sin(p.pennation_angle)
        stiffness = tendon_stiffness(p.tendon_strain)
        low, high = p.min_fiber_length * p.optimal_fiber_length, max(u.path_length, p.optimal_fiber_length)
        for _ in range(60):
            middle = 0.5 * (low + high)
            along = math.sqrt(max(0.0, middle * middle - width * width))
            strain = (u.path_length - along - p.tendon_slack_length) / p.tendon_slack_length
            normalized = middle / p.optimal_fiber_length
            fiber = u.activation_level * active_force(normalized) + passive_force(normalized)
            if tendon_force(strain, stiffness) * middle > fiber * along:
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
        stiffness = tendon_stiffness(p.tendon_strain)
        y.activation = u.activation_level
        y.fiber_length = x.length
        y.normalized_fiber_length = length
        y.pennation = math.asin(sine)
        y.tendon_strain_now = strain
        y.normalized_force = tendon_force(strain, stiffness)
        y.force = p.max_isometric_force * y.normalized_force
        in_tendon = p.tendon_slack_length * (y.normalized_force / stiffness - 0.2 * strain)
        in_fiber = p.optimal_fiber_length * passive_energy(length)
        y.elastic_energy = p.max_isometric_force * (in_tendon + in_fiber)
        y.normalized_isometric_force = active_force(length)
        driving = y.normalized_force / cosine - passive_force(length)
        y.fiber_force = p.max_isometric_force * max(0.0, driving)
        ratio = driving / (u.activation_level * y.normalized_isometric_force)
        y.normalized_fiber_velocity = velocity_from_force(ratio)
        y.fiber_velocity = y.normalized_fiber_velocity * p.max_contraction_velocity * p.optimal_fiber_length

    @staticmethod
    def update(p, u, x, y, dt):
        # At low activation a fiber follows its tendon within less than a step. The force balance is therefore solved
        # at an instant within the step, to which the path and the force of the fiber are extrapolated linearly.
        cosine, stiffness = math.cos(y.pennation), tendon_stiffness(p.tendon_strain)
        v_max = p.max_contraction_velocity * p.optimal_fiber_length
        slope = force_and_slope(min(1.0, max(-1.0, y.normalized_fiber_velocity)))[1]
        strength = y.normalized_isometric_force * u.activation_level
        beside = passive_force(y.normalized_fiber_length)
        loss = v_max * dt / (cosine * p.tendon_slack_length)
        yielding = stiffness * (y.normalized_force + 0.2) * loss if y.normalized_force > 0 else 0.0
        ahead = look_ahead(yielding / (cosine * strength * slope))
        longer = u.path_length + ahead * dt * u.path_velocity - x.length * cosine - p.tendon_slack_length
        velocity = velocity_after(
            y.normalized_fiber_velocity,
            longer / p.tendon_slack_length,
            ahead * loss,
            stiffness,
            cosine,
            beside + ahead * (beside - x.beside_before),
            max(0.5 * strength, strength + ahead * (strength - x.strength_before)),
        )
        x.strength_before, x.beside_before = strength, beside
        # The pennation is at most acos(0.1), as in OpenSim.
        widest = math.sin(p.pennation_angle) / math.sqrt(0.99)
        shortest = max(p.min_fiber_length, widest) * p.optimal_fiber_length
        x.length = max(shortest, x.length + velocity * v_max * dt)
