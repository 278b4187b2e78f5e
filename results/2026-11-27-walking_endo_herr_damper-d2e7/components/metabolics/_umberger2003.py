"""The heat of muscle by Umberger et al. (2003), which later models of metabolic power changed."""

from gaitsim.component import Parameter

AEROBIC = Parameter(
    "1", "S: scale of all heat; 1.5 aerobic, 1 anaerobic.", default=1.5, bounds=(0, 3), source="umberger2003"
)
SLOW_HEAT = Parameter(
    "W/kg", "Activation and maintenance heat of all fibers.", default=25, bounds=(0, 1000), source="umberger2003"
)
FAST_HEAT = Parameter(
    "W/kg",
    "Additional activation and maintenance heat of fast fibers.",
    default=128,
    bounds=(0, 1000),
    source="umberger2003",
)
SLOW_SHORTENING_HEAT = Parameter(
    "W/kg",
    "Largest shortening heat of slow fibers, reached at their v_max.",
    default=100,
    bounds=(0, 1000),
    source="umberger2003",
)
FAST_SHORTENING_HEAT = Parameter(
    "W/kg", "Shortening heat of fast fibers at v_max.", default=153, bounds=(0, 1000), source="umberger2003"
)


def heat_level(excitation, activation):
    """A: the excitation where it exceeds the activation, otherwise the mean of both."""
    return excitation if excitation > activation else 0.5 * (excitation + activation)


def heat_per_mass(p, level, slow, velocity, length, isometric_force):
    """Heat rate per muscle mass, at least `least_heat`; `slow` is the fraction of slow fibers among the active ones."""
    maintenance = p.aerobic * level**0.6 * (p.fast_heat * (1 - slow) + p.slow_heat)
    slow_rise = -2.5 * p.slow_shortening_heat * velocity / p.max_contraction_velocity
    if velocity <= 0:
        fast_rise = -p.fast_shortening_heat * velocity / p.max_contraction_velocity
        moving = level * level * (min(slow_rise, p.slow_shortening_heat) * slow + fast_rise * (1 - slow))
    else:
        moving = -level * p.lengthening * slow_rise
    if length > 1:
        maintenance = maintenance * (0.4 + 0.6 * isometric_force)
        moving = moving * isometric_force
    return max(p.least_heat, maintenance + p.aerobic * moving)
