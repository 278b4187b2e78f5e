import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, Part, StepLimit

LEAST, MOST = math.exp(0.2 * 4 / 0.6), math.exp(1.6 * 4 / 0.6)  # passive elasticity at its ends
# The paper's digits are rounded; OpenSim's are not: f_l is 1 at 1, and f_v is 0 at -1 and 1 at 0.
FIRST = (0.8150671134243542, 1.055033428970575, 0.162384573599574, 0.063303448465465)
SECOND = (0.433004984392647, 0.716775413397760, -0.029947116970696, 0.200356847296188)
THIRD = (0.1, 1.0, 0.353553390593274, 0.0)
D_1, D_2, D_3, D_4 = -0.3211346127989808, -8.149, -0.374, 0.8825327733249912


def gaussian(length, coefficients):
    """b_1 exp(-((l - b_2) / (b_3 + b_4 l))^2 / 2)."""
    height, center, width, widening = coefficients
    offset = (length - center) / (width + widening * length)
    return height * math.exp(-0.5 * offset * offset)


def active_force(length):
    """f_l: three Gaussians whose width grows with the length."""
    return gaussian(length, FIRST) + gaussian(length, SECOND) + gaussian(length, THIRD)


def force_velocity(velocity):
    """f_v = d_1 asinh(d_2 v + d_3) + d_4, v in v_max."""
    return D_1 * math.asinh(D_2 * velocity + D_3) + D_4


def passive_force(length):
    """f_PE: exponential, 0 at 0.2 and 1 at 1.6 optimal lengths."""
    return max(0.0, math.exp(length * 4 / 0.6) - LEAST) / (MOST - LEAST)


def passive_energy(length):
    """Integral of f_PE over the length."""
    long = max(0.2, length)
    return (0.15 * (math.exp(long * 4 / 0.6) - LEAST) - LEAST * (long - 0.2)) / (MOST - LEAST)


class RigidTendon(Component):
    """Hill-type muscle with a tendon that does not yield, the pennate fiber and the curves of De Groote et al. (2016).

    F = F_max (A f_l f_v + f_PE) cos(alpha), where l sin(alpha) is constant and l cos(alpha) is what the
    tendon leaves of the path. It has no state but its activation, so nothing is integrated.
    """

    max_isometric_force = Parameter("N", "F_max.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt.", bounds=(1e-3, 1))
    tendon_slack_length = Parameter("m", "Length of the tendon.", bounds=(1e-3, 2))
    max_contraction_velocity = Parameter(
        "1/s", "v_max in optimal fiber lengths per second.", default=10, bounds=(1, 50), source="degroote2016"
    )
    pennation_angle = Parameter(
        "rad",
        "alpha at the optimal length.",
        default=0,
        bounds=(0, 1.4),
        source="definition: fibers along the tendon",
    )
    min_fiber_length = Parameter(
        "1", "Floor of the fiber in optimal lengths.", default=0.2, bounds=(0.01, 0.9), source="degroote2016: f_PE"
    )

    largest_step = StepLimit(
        "ms",
        "Force within 2 % of F_max of that at 5 us at every instant: an isometric contraction and relaxation, "
        "stretches and releases at half v_max at A = 0.01 and 0.5, 0.3 F_max lifted; soleus, vasti, hip flexors.",
        0.5,
    )

    path = Part(
        "path",
        "Geometry from origin to insertion.",
        reads=(("path_length", "length"), ("path_velocity", "velocity")),
        sends=(("tension", "force"),),
        gives=(("reference_length", "optimal_fiber_length * cos(pennation_angle) + tendon_slack_length"),),
    )
    activation_dynamics = Part(
        "activation",
        "From excitation to activation.",
        default="activation/degroote2016",
        reads=(("activation_level", "activation"),),
        sends=(("excitation", "excitation"),),
    )
    metabolics = Part(
        "metabolics",
        "Metabolic power; a spec that wants it says which.",
        optional=True,
        sends=(
            ("excitation", "excitation"),
            ("activation", "activation"),
            ("normalized_isometric_force", "normalized_isometric_force"),
            ("normalized_fiber_length", "normalized_fiber_length"),
            ("fiber_velocity", "fiber_velocity"),
            ("fiber_force", "fiber_force"),
            ("force", "force"),
        ),
        gives=(
            ("max_isometric_force", "max_isometric_force"),
            ("optimal_fiber_length", "optimal_fiber_length"),
            ("max_contraction_velocity", "max_contraction_velocity"),
        ),
    )
    excitation = Input("1", "Sum of all stimulations.", sums=True)
    activation_level = Input("1", "Activation.")
    path_length = Input(
        "m",
        "Length of the whole muscle-tendon unit.",
        usual=("tendon_slack_length + 0.3 * optimal_fiber_length", 10),  # below it, the tendon is slack
        possible=("0.5 * tendon_slack_length", 10),
    )
    path_velocity = Input("m/s", "Its lengthening velocity.")

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
    elastic_energy = Output("J", "Elastic energy in the parallel element.")

    active_curve = Curve(of="active_force", over="length", span=(0.2, 1.8), doc="f_l over the length in l_opt.")
    velocity_curve = Curve(of="force_velocity", over="velocity", span=(-1, 1), doc="f_v over the velocity in v_max.")
    passive_curve = Curve(of="passive_force", over="length", span=(0.2, 1.8), doc="f_PE over the length in l_opt.")

    @staticmethod
    def output(p, u, x, y):
        width = p.optimal_fiber_length * math.sin(p.pennation_angle)
        along = max(0.0, u.path_length - p.tendon_slack_length)
        y.fiber_length = max(p.min_fiber_length * p.optimal_fiber_length, math.sqrt(along * along + width * width))
        length, cosine = y.fiber_length / p.optimal_fiber_length, along / y.fiber_length
        y.activation = u.activation_level
        y.normalized_fiber_length = length
        y.pennation = math.acos(min(1.0, cosine))
        y.fiber_velocity = u.path_velocity * cosine
        y.normalized_fiber_velocity = y.fiber_velocity / (p.max_contraction_velocity * p.optimal_fiber_length)
        y.normalized_isometric_force = active_force(length)
        moving = max(0.0, force_velocity(y.normalized_fiber_velocity))
        active = u.activation_level * y.normalized_isometric_force * moving
        y.fiber_force = p.max_isometric_force * active
        y.normalized_force = (active + passive_force(length)) * cosine
        y.force = p.max_isometric_force * y.normalized_force
        y.elastic_energy = p.max_isometric_force * p.optimal_fiber_length * passive_energy(length)
