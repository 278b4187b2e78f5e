"""The mass of a muscle, and the parameters from which models of metabolic power compute it."""

from gaitsim.component import Parameter

SLOW_TWITCH = Parameter(
    "1", "r: mass fraction of slow fibers.", default=0.5, bounds=(0, 1), source="definition: half of each kind"
)
SPECIFIC_TENSION = Parameter(
    "MPa",
    "sigma: stress at F_max; mass = F_max / sigma rho l_opt.",
    default=0.25,
    bounds=(0.01, 10),
    source="umberger2003",
)
DENSITY = Parameter("kg/m^3", "rho of muscle.", default=1059.7, bounds=(100, 1e4), source="umberger2003")


def muscle_mass(p):
    """F_max / sigma rho l_opt."""
    return p.max_isometric_force / p.specific_tension * p.density * p.optimal_fiber_length
