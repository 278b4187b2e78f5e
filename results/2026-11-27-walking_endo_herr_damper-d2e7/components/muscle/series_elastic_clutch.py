from gaitsim.component import Component, Curve, Input, Output, Parameter, Part, State


def stretch_beyond(length, rest_length):
    """Stretch of a spring; 0 if it is slack."""
    return max(0.0, length - rest_length)


class SeriesElasticClutch(Component):
    """A clutch in series with a spring: a tendon whose muscle fiber is either isometric or slack, and does no work.

    It follows the clutch of Endo & Herr (2009); its law is our own, because theirs is not published. While the clutch
    is disengaged, F = 0. While it is engaged, F = k max(0, l - l_0), where l_0 is the least length of the path since
    then: slack is taken up without force, stretch is held, and a path that shortens gets all energy back. A clutch
    that is released under load dissipates what the spring holds. The clutch is engaged while the excitation is above
    one half. The force has no time constant, and the pull is along the path: a path with a pennation
    factor below 1 would create energy.

    For metabolics the fiber is an isometric source: the part of it that carries the force is active.
    """

    max_isometric_force = Parameter("N", "F_max of the muscle that the unit stands for.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt of the muscle that the unit stands for.", bounds=(1e-3, 1))
    tendon_slack_length = Parameter("m", "Length of the spring at rest.", bounds=(1e-3, 2))
    max_contraction_velocity = Parameter(
        "1/s", "v_max of the muscle that the unit stands for.", default=12, bounds=(1, 50), source="geyer2003"
    )
    stiffness = Parameter("N/m", "k: force per stretch of the spring.", bounds=(1, 1e8))

    path = Part(
        "path",
        "Geometry from origin to insertion.",
        reads=(("path_length", "length"),),
        sends=(("tension", "force"),),
        gives=(("reference_length", "optimal_fiber_length + tendon_slack_length"),),
    )
    metabolics = Part(
        "metabolics",
        "Metabolic power; optional, chosen by the spec.",
        optional=True,
        sends=(
            ("excitation", "activation"),
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
    excitation = Input("1", "The clutch's gate: engaged above one half.", sums=True)
    path_length = Input("m", "Length of the whole unit.")

    engaged = State(levels=("no", "yes"), doc="Whether the clutch was engaged one step ago.")
    least_length = State("m", "Least length of the path since the clutch was engaged.")
    dissipated = State("J", "Total energy that the spring held at releases of the clutch.")

    force = Output("N", "Force of the unit.")
    normalized_force = Output("1", "Force in F_max.")
    activation = Output("1", "Share of the fiber that carries the force, F / F_max, at most 1.")
    stretch = Output("m", "Stretch of the spring.")
    fiber_length = Output("m", "Length of the fiber: the path less the stretched spring.")
    normalized_fiber_length = Output("1", "Length of the fiber in optimal lengths.")
    normalized_path_length = Output("1", "The path less the spring at rest, in optimal lengths.")
    fiber_velocity = Output("m/s", "0: the fiber is isometric.")
    normalized_fiber_velocity = Output("1", "0.")
    fiber_force = Output("N", "Force of the fiber, that of the spring.")
    normalized_isometric_force = Output("1", "1: the force does not depend on the fiber's length.")
    elastic_energy = Output("J", "Elastic energy of the spring.")
    dissipated_energy = Output("J", "Energy lost by releases under load since the start.")

    spring = Curve(
        "force",
        "path_length",
        (0.38, 0.43),
        "Force over the length of the path: engaged at 0.4 m, and disengaged.",
        at={
            "max_isometric_force": 1500,
            "optimal_fiber_length": 0.05,
            "tendon_slack_length": 0.35,
            "stiffness": 60000,
            "engaged": 1,
            "least_length": 0.4,
        },
        each=("excitation", (1, 0)),
    )

    @staticmethod
    def start(p, u, x):
        x.engaged = 0
        x.least_length = u.path_length

    @staticmethod
    def output(p, u, x, y):
        held = u.excitation > 0.5 and x.engaged > 0.5
        y.stretch = stretch_beyond(u.path_length, x.least_length) if held else 0.0 * u.path_length
        y.force = p.stiffness * y.stretch
        y.fiber_force = y.force
        y.normalized_force = y.force / p.max_isometric_force
        y.activation = min(1.0, y.normalized_force)
        y.fiber_length = u.path_length - y.stretch - p.tendon_slack_length
        y.normalized_fiber_length = y.fiber_length / p.optimal_fiber_length
        y.normalized_path_length = (u.path_length - p.tendon_slack_length) / p.optimal_fiber_length
        y.fiber_velocity = 0.0
        y.normalized_fiber_velocity = 0.0
        y.normalized_isometric_force = 1.0
        y.elastic_energy = 0.5 * p.stiffness * y.stretch**2
        y.dissipated_energy = x.dissipated

    @staticmethod
    def update(p, u, x, y, dt):
        engaged = u.excitation > 0.5
        if x.engaged > 0.5 and not engaged:
            x.dissipated = x.dissipated + 0.5 * p.stiffness * stretch_beyond(u.path_length, x.least_length) ** 2
        carries_on = engaged and x.engaged > 0.5
        x.least_length = min(x.least_length, u.path_length) if carries_on else u.path_length
        x.engaged = 1 if engaged else 0
