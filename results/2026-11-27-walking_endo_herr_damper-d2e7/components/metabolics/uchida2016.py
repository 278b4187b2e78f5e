import math

from gaitsim.component import Component, Input, Output, Parameter

from ._mass import DENSITY, SLOW_TWITCH, SPECIFIC_TENSION, muscle_mass
from ._umberger2003 import (
    AEROBIC,
    FAST_HEAT,
    FAST_SHORTENING_HEAT,
    SLOW_HEAT,
    SLOW_SHORTENING_HEAT,
    heat_level,
    heat_per_mass,
)


class Uchida2016(Component):
    """Metabolic power of Umberger et al. (2003) as changed by Uchida et al. (2016): OpenSim's default.

    Slow fibers are recruited first: the fraction of slow ones among those that are active is
    r sin(pi u / 2) / [r sin(pi u / 2) + (1 - r) (1 - cos(pi u / 2))], 1 at u = 0. Negative work counts, but
    total power does not fall below 0: the energy absorbed by a lengthening fiber becomes heat.
    """

    max_isometric_force = Parameter("N", "F_max of the muscle.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt of the muscle.", bounds=(1e-3, 1))
    max_contraction_velocity = Parameter("1/s", "v_max of the muscle in l_opt per second.", bounds=(1, 50))
    slow_twitch = SLOW_TWITCH
    specific_tension = SPECIFIC_TENSION
    density = DENSITY
    aerobic = AEROBIC
    slow_heat = SLOW_HEAT
    fast_heat = FAST_HEAT
    slow_shortening_heat = SLOW_SHORTENING_HEAT
    fast_shortening_heat = FAST_SHORTENING_HEAT
    lengthening = Parameter(
        "1", "Lengthening heat in shortening heats of slow fibers.", default=4, bounds=(0, 100), source="umberger2003"
    )
    least_heat = Parameter("W/kg", "Heat does not fall below this.", default=1, bounds=(0, 100), source="umberger2003")

    excitation = Input("1", "Excitation u; clipped to [0, 1].", sums=True)
    activation = Input("1", "Activation a.")
    normalized_isometric_force = Input("1", "f_l of the fiber.")
    normalized_fiber_length = Input("1", "Fiber length l in l_opt.")
    fiber_velocity = Input("m/s", "Fiber velocity, shortening negative.")
    fiber_force = Input("N", "Active force of the fiber, F_CE.")
    force = Input("N", "Force of the muscle-tendon unit.")

    power = Output("W", "Metabolic power of the muscle.")
    heat = Output("W", "Rate of heat production.")
    work = Output("W", "Mechanical power of the fiber; negative while it lengthens.")

    @staticmethod
    def output(p, u, x, y):
        excitation = min(1.0, max(0.0, u.excitation))
        level = heat_level(excitation, u.activation)
        velocity = u.fiber_velocity / p.optimal_fiber_length
        slow_share = p.slow_twitch * math.sin(0.5 * math.pi * excitation)
        fast_share = (1 - p.slow_twitch) * (1 - math.cos(0.5 * math.pi * excitation))
        active = slow_share + fast_share
        slow = slow_share / active if active > 0 else 1.0
        length, isometric = u.normalized_fiber_length, u.normalized_isometric_force
        y.heat = muscle_mass(p) * heat_per_mass(p, level, slow, velocity, length, isometric)
        y.work = -u.fiber_force * u.fiber_velocity
        y.heat = max(y.heat, -y.work)
        y.power = y.heat + y.work
