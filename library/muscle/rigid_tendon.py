import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, Part, StepLimit

from ._degroote2016 import active_force, force_velocity, passive_energy, passive_force
from ._hill import METABOLICS, PATH_LENGTH, PENNATE_PATH, PENNATION_ANGLE, STEP_MEASURE


class RigidTendon(Component):
    """Hill-type muscle with a rigid tendon, a pennate fiber and the curves of De Groote et al. (2016).

    F = F_max (A f_l f_v + f_PE) cos(alpha), where l sin(alpha) is constant and l cos(alpha) is the
    path length minus the tendon length. The only state is that of the activation, so no fiber length is integrated.
    """

    max_isometric_force = Parameter("N", "F_max.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt.", bounds=(1e-3, 1))
    tendon_slack_length = Parameter("m", "Length of the tendon.", bounds=(1e-3, 2))
    max_contraction_velocity = Parameter(
        "1/s", "v_max in optimal fiber lengths per second.", default=10, bounds=(1, 50), source="degroote2016"
    )
    pennation_angle = PENNATION_ANGLE
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
