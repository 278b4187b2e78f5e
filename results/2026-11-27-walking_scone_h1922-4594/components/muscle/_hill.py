"""Declarations and functions that Hill-type muscle-tendon units share."""

from gaitsim.component import Input, Parameter, Part

# How the largest step of a muscle is measured.
STEP_MEASURE = (
    "Force within 2 % of F_max of that at 5 us at every instant: an isometric contraction and relaxation, "
    "stretches and releases at half v_max at A = 0.01 and 0.5, 0.3 F_max lifted; soleus, vasti, hip flexors."
)

PENNATION_ANGLE = Parameter(
    "rad",
    "alpha at the optimal length.",
    default=0,
    bounds=(0, 1.4),
    source="definition: fibers along the tendon",
)
PENNATE_PATH = Part(
    "path",
    "Geometry from origin to insertion.",
    reads=(("path_length", "length"), ("path_velocity", "velocity")),
    sends=(("tension", "force"),),
    gives=(("reference_length", "optimal_fiber_length * cos(pennation_angle) + tendon_slack_length"),),
)
METABOLICS = Part(
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
PATH_LENGTH = Input(
    "m",
    "Length of the whole muscle-tendon unit.",
    usual=("tendon_slack_length + 0.3 * optimal_fiber_length", 10),  # below it, the tendon is slack
    possible=("0.5 * tendon_slack_length", 10),
)


def look_ahead(stiffness):
    """Share of a step after which the force balance is solved: 1/2 for slow changes, towards 1 for fast ones."""
    return (3 + stiffness) / (6 + stiffness)
