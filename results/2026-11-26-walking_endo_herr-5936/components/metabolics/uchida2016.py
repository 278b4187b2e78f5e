import math

from gaitsim.component import Component, Input, Output, Parameter


class Uchida2016(Component):
    """Metabolic power of Umberger et al. (2003) as changed by Uchida et al. (2016): OpenSim's default.

    Slow fibers are recruited first: the fraction of slow ones among those that are active is
    r sin(pi u / 2) / [r sin(pi u / 2) + (1 - r) (1 - cos(pi u / 2))], 1 at u = 0. Negative work counts, but
    total power does not fall below 0: what a lengthening fiber takes up becomes heat.
    """

    max_isometric_force = Parameter("N", "F_max of the muscle.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt of the muscle.", bounds=(1e-3, 1))
    max_contraction_velocity = Parameter("1/s", "v_max of the muscle in l_opt per second.", bounds=(1, 50))
    slow_twitch = Parameter(
        "1", "r: mass fraction of slow fibers.", default=0.5, bounds=(0, 1), source="definition: half of each kind"
    )
    specific_tension = Parameter(
        "MPa",
        "sigma: stress at F_max; mass = F_max / sigma rho l_opt.",
        default=0.25,
        bounds=(0.01, 10),
        source="umberger2003",
    )
    density = Parameter("kg/m^3", "rho of muscle.", default=1059.7, bounds=(100, 1e4), source="umberger2003")
    aerobic = Parameter(
        "1", "S: scale of all heat; 1.5 aerobic, 1 anaerobic.", default=1.5, bounds=(0, 3), source="umberger2003"
    )
    slow_heat = Parameter(
        "W/kg", "Activation and maintenance heat of all fibers.", default=25, bounds=(0, 1000), source="umberger2003"
    )
    fast_heat = Parameter("W/kg", "What fast fibers add to it.", default=128, bounds=(0, 1000), source="umberger2003")
    slow_shortening_heat = Parameter(
        "W/kg",
        "Shortening heat of slow fibers at their v_max, and their most.",
        default=100,
        bounds=(0, 1000),
        source="umberger2003",
    )
    fast_shortening_heat = Parameter(
        "W/kg", "Shortening heat of fast fibers at v_max.", default=153, bounds=(0, 1000), source="umberger2003"
    )
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
    heat = Output("W", "What of it is heat.")
    work = Output("W", "What of it is mechanical work; negative while the fiber lengthens.")

    @staticmethod
    def output(p, u, x, y):
        mass = p.max_isometric_force / p.specific_tension * p.density * p.optimal_fiber_length
        excitation = min(1.0, max(0.0, u.excitation))
        level = excitation if excitation > u.activation else 0.5 * (excitation + u.activation)
        velocity = u.fiber_velocity / p.optimal_fiber_length
        slow_share = p.slow_twitch * math.sin(0.5 * math.pi * excitation)
        fast_share = (1 - p.slow_twitch) * (1 - math.cos(0.5 * math.pi * excitation))
        active = slow_share + fast_share
        slow = slow_share / active if active > 0 else 1.0
        maintenance = p.aerobic * level**0.6 * (p.fast_heat * (1 - slow) + p.slow_heat)
        slow_rise = -2.5 * p.slow_shortening_heat * velocity / p.max_contraction_velocity
        if velocity <= 0:
            fast_rise = -p.fast_shortening_heat * velocity / p.max_contraction_velocity
            moving = level * level * (min(slow_rise, p.slow_shortening_heat) * slow + fast_rise * (1 - slow))
        else:
            moving = -level * p.lengthening * slow_rise
        if u.normalized_fiber_length > 1:
            maintenance = maintenance * (0.4 + 0.6 * u.normalized_isometric_force)
            moving = moving * u.normalized_isometric_force
        y.heat = mass * max(p.least_heat, maintenance + p.aerobic * moving)
        y.work = -u.fiber_force * u.fiber_velocity
        y.heat = max(y.heat, -y.work)
        y.power = y.heat + y.work
