from gaitsim.component import Component, Curve, Input, Output, Parameter, Part


def force_length(length, width):
    """f_l = max(0, 1 - ((l - 1) / w)^2): a parabola, as a starting point."""
    return max(0.0, 1 - ((length - 1) / width) ** 2)


def force_velocity(velocity, eccentric):
    """f_v for v in v_max, shortening negative: linear to 0 at -1, and to `eccentric` at 1."""
    if velocity < 0:
        return max(0.0, 1 + velocity)
    return min(eccentric, 1 + velocity)


class Skeleton(Component):
    """A muscle with a rigid tendon, F = F_max A f_l(l) f_v(v); replace it by your equations, and cite their paper.

    Everything that kind.yaml requires is declared below; declare further parameters and states of your muscle likewise.
    """

    max_isometric_force = Parameter("N", "F_max.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt.", bounds=(1e-3, 1))
    tendon_slack_length = Parameter("m", "Length of the rigid tendon.", bounds=(1e-3, 2))
    max_contraction_velocity = Parameter(
        "1/s", "v_max in optimal fiber lengths per second.", default=12, bounds=(1, 50), source="geyer2003"
    )
    width = Parameter(
        "1", "w: half width of f_l in optimal lengths.", default=0.56, bounds=(0.1, 0.95), source="geyer2010"
    )
    eccentric_force = Parameter(
        "1", "f_v at the largest lengthening velocity.", default=1.5, bounds=(1, 3), source="geyer2010"
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
    metabolics = Part(
        "metabolics",
        "Metabolic power; optional, chosen by the spec.",
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
    path_velocity = Input("m/s", "Its rate.")

    force = Output("N", "Force of the muscle-tendon unit.")
    normalized_force = Output("1", "Force in F_max.", usual=(0, 1.5), possible=(0, 10))
    activation = Output("1", "Activation A.")
    fiber_length = Output("m", "Length of the fiber.")
    normalized_fiber_length = Output(
        "1", "Length of the fiber in optimal lengths.", usual=(0.4, 1.6), possible=(0, 2.5)
    )
    fiber_velocity = Output("m/s", "Rate of the fiber's length, shortening negative.")
    normalized_fiber_velocity = Output("1", "Velocity of the fiber in v_max.")
    fiber_force = Output("N", "Active force of the fiber, A F_max f_l f_v.")
    normalized_isometric_force = Output("1", "f_l: active force in F_max, at rest and full activation.")
    elastic_energy = Output("J", "Elastic energy: a rigid tendon stores none.")

    active = Curve("force_length", "length", (0.4, 1.6), "Active force over the fiber's length.")
    moving = Curve(
        "force_velocity",
        "velocity",
        (-1.2, 1),
        "Force over the fiber's velocity.",
        at={"eccentric": "eccentric_force"},
    )

    @staticmethod
    def output(p, u, x, y):
        y.activation = u.activation_level
        y.fiber_length = max(0.0, u.path_length - p.tendon_slack_length)
        y.fiber_velocity = u.path_velocity
        y.normalized_fiber_length = y.fiber_length / p.optimal_fiber_length
        y.normalized_fiber_velocity = u.path_velocity / (p.max_contraction_velocity * p.optimal_fiber_length)
        y.normalized_isometric_force = force_length(y.normalized_fiber_length, p.width)
        moving = force_velocity(y.normalized_fiber_velocity, p.eccentric_force)
        y.normalized_force = u.activation_level * y.normalized_isometric_force * moving
        y.force = p.max_isometric_force * y.normalized_force
        y.fiber_force = y.force
        y.elastic_energy = 0.0
