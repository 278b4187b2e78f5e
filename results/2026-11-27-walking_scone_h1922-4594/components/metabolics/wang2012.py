import math

from gaitsim.component import Component, Input, Output, Parameter

from ._mass import DENSITY, SLOW_TWITCH, SPECIFIC_TENSION, muscle_mass


class Wang2012(Component):
    """Metabolic power by activation, maintenance and shortening heat and positive work (Wang et al. 2012).

    A' = m [40 r sin(pi u/2) + 133 (1 - r) (1 - cos(pi u/2))]; M' likewise with 74, 111 and the activation a
    for u, times 1 at the optimal length, 0.5 at half of it, 0 at 1.5; S' = 0.25 F |v| and W' = F |v| while the
    fiber shortens. The basal power in that paper is 1.51 W/kg.
    """

    max_isometric_force = Parameter("N", "F_max of the muscle.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt of the muscle.", bounds=(1e-3, 1))
    max_contraction_velocity = Parameter("1/s", "v_max of the muscle in l_opt per second.", bounds=(1, 50))
    slow_twitch = SLOW_TWITCH
    specific_tension = SPECIFIC_TENSION
    density = DENSITY
    slow_activation_heat = Parameter(
        "W/kg", "Activation heat of slow fibers.", default=40, bounds=(0, 1000), source="wang2012"
    )
    fast_activation_heat = Parameter(
        "W/kg", "Activation heat of fast fibers.", default=133, bounds=(0, 1000), source="wang2012"
    )
    slow_maintenance_heat = Parameter(
        "W/kg", "Maintenance heat of slow fibers.", default=74, bounds=(0, 1000), source="wang2012"
    )
    fast_maintenance_heat = Parameter(
        "W/kg", "Maintenance heat of fast fibers.", default=111, bounds=(0, 1000), source="wang2012"
    )
    shortening_share = Parameter(
        "1", "Shortening heat per force and velocity.", default=0.25, bounds=(0, 10), source="wang2012"
    )

    excitation = Input("1", "Excitation u; clipped to [0, 1].", sums=True)
    activation = Input("1", "Activation a.")
    normalized_isometric_force = Input("1", "f_l of the fiber.")
    normalized_fiber_length = Input("1", "Fiber length l in l_opt.")
    fiber_velocity = Input("m/s", "Fiber velocity, shortening negative.")
    fiber_force = Input("N", "Active force of the fiber, F_CE.")
    force = Input("N", "Force of the muscle-tendon unit.")

    power = Output("W", "Metabolic power of the muscle.")
    heat = Output("W", "Rate of heat production.")
    work = Output("W", "Mechanical power of the fiber; 0 while it lengthens.")

    @staticmethod
    def output(p, u, x, y):
        mass = muscle_mass(p)
        excited = 0.5 * math.pi * min(1.0, max(0.0, u.excitation))
        active = 0.5 * math.pi * u.activation
        slow, fast = p.slow_twitch, 1 - p.slow_twitch
        length = u.normalized_fiber_length
        reach = max(0.5, length) if length < 1 else max(0.0, 3 - 2 * length)
        activating = p.slow_activation_heat * slow * math.sin(excited)
        activating = activating + p.fast_activation_heat * fast * (1 - math.cos(excited))
        maintaining = p.slow_maintenance_heat * slow * math.sin(active)
        maintaining = maintaining + p.fast_maintenance_heat * fast * (1 - math.cos(active))
        y.work = max(0.0, -u.fiber_force * u.fiber_velocity)
        y.heat = mass * (activating + reach * maintaining) + p.shortening_share * y.work
        y.power = y.heat + y.work
