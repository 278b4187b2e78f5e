import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, Part, State, StepLimit

from ._hill import METABOLICS, PATH_LENGTH, PENNATE_PATH, PENNATION_ANGLE, STEP_MEASURE, look_ahead

# Dimensionless defaults of OpenSim's Millard2012EquilibriumMuscle (millard2013).
PASSIVE_STRAIN = 0.7  # of the fiber at F_max
TOE_END = 1 - (1 - 2 / 3) / 1.375  # where the tendon becomes linear, in strains at F_max
GAUSS = (  # nodes and weights on [0, 1]; five integrate polynomials of degree nine exactly
    (0.5, 0.28444444444444444),
    (0.23076534494715845, 0.23931433524968324),
    (0.7692346550528415, 0.23931433524968324),
    (0.046910077030668, 0.11846344252809454),
    (0.953089922969332, 0.11846344252809454),
)


def elbow(x0, y0, slope0, x1, y1, slope1, curviness):
    """Quintic Bezier section between two tangents: its control points, the inner two of which count twice."""
    c = 0.1 + 0.8 * curviness
    x = (y1 - y0 - x1 * slope1 + x0 * slope0) / (slope0 - slope1)
    y = y1 + (x - x1) * slope1
    across = (float(x0), x0 + c * (x - x0), x1 + c * (x - x1), float(x1))
    return (*across, float(y0), y0 + c * (y - y0), y1 + c * (y - y1), float(y1))


def active_sections(minimum):
    """f_l: fiber lengths 0.4441, 0.73, 1, 1.8123 in l_opt, shallow slope 0.8616, curviness 1."""
    shoulder = 0.05
    steep_end = 1 - 0.8616 * (1 - shoulder - 0.73)
    ascent = (0.4441 + 0.5 * (0.73 - 0.4441), 0.5 * steep_end, 1.25 * steep_end / (0.73 - 0.4441))
    shallow = (0.73 + 0.5 * (1 - shoulder - 0.73), 0.5 * (1 + steep_end), 0.8616)
    descent = (0.5 * (1 + shoulder + 1.8123), 0.5, -1 / (1.8123 - 1 - 2 * shoulder))
    return (
        elbow(0.4441, minimum, 0, *ascent, 1),
        elbow(*ascent, *shallow, 1),
        elbow(*shallow, 1, 1, 0, 1),
        elbow(1, 1, 0, *descent, 1),
        elbow(*descent, 1.8123, minimum, 0, 1),
    )


ACTIVE = active_sections(0)  # with damping the active force may vanish at the ends
VELOCITY = (
    elbow(-1, 0, 0, -0.9, 0.0125, 0.25, 0.6),
    elbow(-0.9, 0.0125, 0.25, 0, 1, 5, 0.6),
    elbow(0, 1, 5, 0.9, 1.3925, 0.15, 0.9),
    elbow(0.9, 1.3925, 0.15, 1, 1.4, 0, 0.9),
)
# Over the strain in strains at F_max: slope 0.2 per l_opt at low force and 2 at F_max.
PASSIVE = (
    elbow(0, 0, 0, 0.05, 0.025 * 0.2 * PASSIVE_STRAIN, 0.2 * PASSIVE_STRAIN, 0.75),
    elbow(0.05, 0.025 * 0.2 * PASSIVE_STRAIN, 0.2 * PASSIVE_STRAIN, 1, 1, 2, 0.75),
)
# The toe ends at 2/3 F_max with slope 1.375; its two sections meet above half of the line's foot.
FOOT = 0.1 * TOE_END
MIDDLE = 1 + (1 / 3 - 1) / 1.375
TENDON = (
    elbow(0, 0, 0, 0.5 * (FOOT + MIDDLE), 1 / 6, 1 / 3 / (MIDDLE - FOOT), 0.5),
    elbow(0.5 * (FOOT + MIDDLE), 1 / 6, 1 / 3 / (MIDDLE - FOOT), TOE_END, 2 / 3, 1.375, 0.5),
)


def bezier(u, p0, p1, p2, p3):
    """A quintic Bezier polynomial whose inner control points count twice, by powers of u."""
    a, b = 5 * (p1 - p0), 5 * (p2 - p0)
    square = u * u
    return p0 + a * u + square * (2 * (b * u - a) + square * (2 * a - 3 * b + (b - a + p3 - p0) * u))


def bezier_slope(u, p0, p1, p2, p3):
    """Its derivative with respect to u."""
    v = 1 - u
    a, b = u * u, v * v
    return 5 * ((p1 - p0) * b * b + 6 * (p2 - p1) * a * b + (p3 - p2) * a * a)


def bezier_parameter(x, p0, p1, p2, p3):
    """u where an increasing Bezier polynomial is x, by three Halley steps, to 1e-12 of its rise."""
    rise, whole = x - p0, p3 - p0
    a, b = 5 * (p1 - p0), 5 * (p2 - p0)
    c, d = 2 * a - 3 * b, b - a + whole
    part, half = rise / whole, (3 * (a + b) + whole) / (32 * whole)
    u = part + min(1.0, max(-1.0, (0.5 - half) / (half * (1 - half)))) * part * (1 - part)
    for _ in range(3):
        square = u * u
        rest = a * u - rise + square * (2 * (b * u - a) + square * (c + d * u))
        slope = a + u * (6 * b * u - 4 * a) + square * u * (4 * c + 5 * d * u)
        curvature = 12 * b * u - 4 * a + square * (12 * c + 20 * d * u)
        u = min(1.0, max(0.0, u - 2 * rest * slope / (2 * slope * slope - rest * curvature)))
    return u


def value(x, section):
    """y of one section at x."""
    u = bezier_parameter(x, section[0], section[1], section[2], section[3])
    return bezier(u, section[4], section[5], section[6], section[7])


def value_and_slope(x, section):
    """y of one section at x, and its slope."""
    u = bezier_parameter(x, section[0], section[1], section[2], section[3])
    rise = bezier_slope(u, section[4], section[5], section[6], section[7])
    run = bezier_slope(u, section[0], section[1], section[2], section[3])
    return bezier(u, section[4], section[5], section[6], section[7]), rise / run


def value_and_area(x, section):
    """y of one section at x, and its integral over x from the beginning of the section."""
    u = bezier_parameter(x, section[0], section[1], section[2], section[3])
    area = 0.0
    for node, weight in GAUSS:
        height = bezier(node * u, section[4], section[5], section[6], section[7])
        area = area + weight * height * bezier_slope(node * u, section[0], section[1], section[2], section[3])
    return bezier(u, section[4], section[5], section[6], section[7]), area * u


PASSIVE_AREA = value_and_area(PASSIVE[0][3], PASSIVE[0])[1]
TENDON_AREA = value_and_area(TENDON[0][3], TENDON[0])[1]


def active_force(length):
    """f_l of the active fiber."""
    inside = min(ACTIVE[4][3], max(ACTIVE[0][0], length))
    if inside < ACTIVE[2][0]:
        section = ACTIVE[0] if inside < ACTIVE[1][0] else ACTIVE[1]
    elif inside < ACTIVE[3][0]:
        section = ACTIVE[2]
    else:
        section = ACTIVE[3] if inside < ACTIVE[4][0] else ACTIVE[4]
    return value(inside, section)


def passive(strain):
    """f_PE over the fiber's strain in strains at F_max, and its integral."""
    if strain <= 0:
        return 0.0, 0.0
    inside = min(1.0, strain)
    first = inside < PASSIVE[0][3]
    force, area = value_and_area(inside, PASSIVE[0] if first else PASSIVE[1])
    beyond = max(0.0, strain - 1)
    return force + 2 * beyond, area + (0.0 if first else PASSIVE_AREA) + beyond * (1 + beyond)


def tendon(strain):
    """f_T over the tendon's strain in strains at F_max, and its integral."""
    inside = min(TOE_END, max(0.0, strain))
    first = inside < TENDON[0][3]
    force, area = value_and_area(inside, TENDON[0] if first else TENDON[1])
    beyond = max(0.0, strain - TOE_END)
    area = area + (0.0 if first else TENDON_AREA) + beyond * (2 / 3 + 0.5 * 1.375 * beyond)
    return force + 1.375 * beyond, area


def tendon_and_slope(strain):
    """f_T over the tendon's strain in strains at F_max, and its slope."""
    inside = min(TOE_END, max(0.0, strain))
    force, slope = value_and_slope(inside, TENDON[0] if inside < TENDON[0][3] else TENDON[1])
    return force + 1.375 * max(0.0, strain - TOE_END), slope


def passive_force(strain):
    """f_PE over the fiber's strain in strains at F_max."""
    inside = min(1.0, max(0.0, strain))
    return value(inside, PASSIVE[0] if inside < PASSIVE[0][3] else PASSIVE[1]) + 2 * max(0.0, strain - 1)


def tendon_force(strain):
    """f_T over the tendon's strain in strains at F_max."""
    return tendon_and_slope(strain)[0]


def velocity_section(first, second, third):
    """The section of f_v, from whether v is below -0.9, below 0 and below 0.9."""
    return VELOCITY[0] if first else VELOCITY[1] if second else VELOCITY[2] if third else VELOCITY[3]


def force_velocity(velocity):
    """f_v and its slope."""
    inside = min(1.0, max(-1.0, velocity))
    return value_and_slope(inside, velocity_section(inside < -0.9, inside < 0, inside < 0.9))


def velocity_from_force(force, active, damping):
    """v at which active f_v(v) + damping v is the force: each section is one Bezier polynomial for both."""
    inside = min(1.4 * active + damping, max(-damping, force))
    slow = 0.9 * damping
    section = velocity_section(inside < 0.0125 * active - slow, inside < active, inside < 1.3925 * active + slow)
    u = bezier_parameter(
        inside,
        active * section[4] + damping * section[0],
        active * section[5] + damping * section[1],
        active * section[6] + damping * section[2],
        active * section[7] + damping * section[3],
    )
    return bezier(u, section[0], section[1], section[2], section[3]) + (force - inside) / damping


def velocity_after(velocity, strain, loss, cosine, beside, strength, damping):
    """Velocity at which the balance holds if the tendon has `strain` - `loss` v, in strains at F_max."""
    for _ in range(20):
        pull, stiffness = tendon_and_slope(strain - loss * velocity)
        force, slope = force_velocity(velocity)
        rest = pull / cosine - beside - strength * force - damping * velocity
        step = rest / (stiffness * loss / cosine + strength * slope + damping)
        velocity = velocity + step
        if abs(step) < 1e-6:
            break
    return velocity


class Millard2012(Component):
    """Hill-type muscle-tendon unit with an elastic tendon, a pennate fiber and fiber damping (Millard et al. 2013).

    F_max (A f_l f_v + f_PE + beta v) cos(alpha) = F_max f_T, where l sin(alpha) is constant; all curves
    are quintic Bezier splines with the defaults of OpenSim's Millard2012EquilibriumMuscle. It starts in
    equilibrium, at rest.
    """

    max_isometric_force = Parameter("N", "F_max.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt.", bounds=(1e-3, 1))
    tendon_slack_length = Parameter("m", "l_slack.", bounds=(1e-3, 2))
    max_contraction_velocity = Parameter(
        "1/s", "v_max in optimal fiber lengths per second.", default=10, bounds=(1, 50), source="millard2013"
    )
    pennation_angle = PENNATION_ANGLE
    tendon_strain = Parameter(
        "1", "Strain of the tendon at F_max.", default=0.049, bounds=(1e-3, 1), source="millard2013"
    )
    damping = Parameter("1", "beta: damping in F_max per v_max.", default=0.1, bounds=(0.02, 10), source="millard2013")
    min_fiber_length = Parameter(
        "1", "Smallest fiber length, in optimal lengths.", default=0.4441, bounds=(0.01, 0.9), source="millard2013"
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
    velocity_curve = Curve(
        of="velocity_from_force",
        over="force",
        span=(-0.1, 1.5),
        doc="f_v + 0.1 v over the velocity in v_max.",
        at={"active": 1, "damping": "damping"},
        inverse=True,
    )
    passive_curve = Curve(of="passive_force", over="strain", span=(-0.2, 1.2), doc="f_PE over the strain / 0.7.")
    tendon_curve = Curve(of="tendon_force", over="strain", span=(-0.2, 1.2), doc="f_T over the strain / 0.049.")

    @staticmethod
    def start(p, u, x):
        # At rest the residual of the force balance grows with the fiber length, so it has one root, found by bisection.
        width = p.optimal_fiber_length * math.sin(p.pennation_angle)
        low, high = p.min_fiber_length * p.optimal_fiber_length, max(u.path_length, p.optimal_fiber_length)
        for _ in range(60):
            middle = 0.5 * (low + high)
            along = math.sqrt(max(0.0, middle * middle - width * width))
            strain = (u.path_length - along - p.tendon_slack_length) / (p.tendon_slack_length * p.tendon_strain)
            normalized = middle / p.optimal_fiber_length
            fiber = u.activation_level * active_force(normalized) + passive_force((normalized - 1) / PASSIVE_STRAIN)
            if tendon_force(strain) * middle > fiber * along:
                low = middle
            else:
                high = middle
        x.length = 0.5 * (low + high)
        length = x.length / p.optimal_fiber_length
        x.strength_before = u.activation_level * active_force(length)
        x.beside_before = passive_force((length - 1) / PASSIVE_STRAIN)

    @staticmethod
    def output(p, u, x, y):
        length = x.length / p.optimal_fiber_length
        sine = min(p.optimal_fiber_length * math.sin(p.pennation_angle) / x.length, 1.0)
        cosine = math.sqrt(1 - sine * sine)
        strain = max(0.0, (u.path_length - x.length * cosine - p.tendon_slack_length) / p.tendon_slack_length)
        pull, in_tendon = tendon(strain / p.tendon_strain)
        beside, in_fiber = passive((length - 1) / PASSIVE_STRAIN)
        y.activation = u.activation_level
        y.fiber_length = x.length
        y.normalized_fiber_length = length
        y.pennation = math.asin(sine)
        y.tendon_strain_now = strain
        y.normalized_force = pull
        y.force = p.max_isometric_force * pull
        in_tendon = p.tendon_slack_length * p.tendon_strain * in_tendon
        in_fiber = p.optimal_fiber_length * PASSIVE_STRAIN * in_fiber
        y.elastic_energy = p.max_isometric_force * (in_tendon + in_fiber)
        y.normalized_isometric_force = active_force(length)
        driving = pull / cosine - beside
        velocity = velocity_from_force(driving, u.activation_level * y.normalized_isometric_force, p.damping)
        y.fiber_force = p.max_isometric_force * (driving - p.damping * velocity)
        y.normalized_fiber_velocity = velocity
        y.fiber_velocity = velocity * p.max_contraction_velocity * p.optimal_fiber_length

    @staticmethod
    def update(p, u, x, y, dt):
        # At low activation a fiber follows its tendon within less than a step. The force balance is therefore solved
        # at an instant within the step, to which the path and the force of the fiber are extrapolated linearly.
        cosine, tendon_length = math.cos(y.pennation), p.tendon_slack_length * p.tendon_strain
        v_max = p.max_contraction_velocity * p.optimal_fiber_length
        strength = y.normalized_isometric_force * u.activation_level
        loss = v_max * dt / (cosine * tendon_length)
        stiffness = tendon_and_slope(y.tendon_strain_now / p.tendon_strain)[1] / cosine
        slope = force_velocity(y.normalized_fiber_velocity)[1]
        beside = passive_force((y.normalized_fiber_length - 1) / PASSIVE_STRAIN)
        ahead = look_ahead(stiffness * loss / (strength * slope + p.damping))
        longer = u.path_length + ahead * dt * u.path_velocity - x.length * cosine - p.tendon_slack_length
        velocity = velocity_after(
            y.normalized_fiber_velocity,
            longer / tendon_length,
            ahead * loss,
            cosine,
            beside + ahead * (beside - x.beside_before),
            max(0.5 * strength, strength + ahead * (strength - x.strength_before)),
            p.damping,
        )
        x.strength_before, x.beside_before = strength, beside
        # OpenSim's floor: a pennation of acos(0.1), or the shortest fiber that has active force.
        widest = math.sin(p.pennation_angle) / math.sqrt(0.99)
        shortest = max(p.min_fiber_length, widest) * p.optimal_fiber_length
        x.length = max(shortest, x.length + velocity * v_max * dt)
