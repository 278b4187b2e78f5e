import math

from gaitsim.component import Component, Input, Output, Parameter

from ._mass import DENSITY, SLOW_TWITCH, SPECIFIC_TENSION, muscle_mass


class Bhargava2004(Component):
    """Metabolic power by activation, maintenance and shortening heat and work (Bhargava et al. 2004).

    A' = m [40 r sin(pi u/2) + 133 (1 - r) (1 - cos(pi u/2))]; M' likewise with 74 and 111, times 1 at the
    optimal length, 0.5 at half of it, 0 at 1.5; S' = -(0.16 A F_max f_l + 0.18 F) v while the fiber
    shortens and -0.157 F v while it lengthens; W' = -F_CE v. The decay of activation heat is left out,
    as in OpenSim, whose simpler S' is 0, 0.25 and 0 here. F is the force of the whole unit: pennation
    is neglected. Power does not fall below 0, nor heat below 1 W/kg (Umberger et al. 2003; Uchida et al. 2016).
    """

    max_isometric_force = Parameter("N", "F_max of the muscle.", bounds=(1, 1e6))
    optimal_fiber_length = Parameter("m", "l_opt of the muscle.", bounds=(1e-3, 1))
    max_contraction_velocity = Parameter("1/s", "v_max of the muscle in l_opt per second.", bounds=(1, 50))
    slow_twitch = SLOW_TWITCH
    specific_tension = SPECIFIC_TENSION
    density = DENSITY
    slow_activation_heat = Parameter(
        "W/kg", "Activation heat of slow fibers.", default=40, bounds=(0, 1000), source="bhargava2004"
    )
    fast_activation_heat = Parameter(
        "W/kg", "Activation heat of fast fibers.", default=133, bounds=(0, 1000), source="bhargava2004"
    )
    slow_maintenance_heat = Parameter(
        "W/kg", "Maintenance heat of slow fibers.", default=74, bounds=(0, 1000), source="bhargava2004"
    )
    fast_maintenance_heat = Parameter(
        "W/kg", "Maintenance heat of fast fibers.", default=111, bounds=(0, 1000), source="bhargava2004"
    )
    isometric_share = Parameter(
        "1", "Shortening heat per isometric force and velocity.", default=0.16, bounds=(0, 10), source="bhargava2004"
    )
    total_share = Parameter(
        "1", "Shortening heat per force and velocity.", default=0.18, bounds=(0, 10), source="bhargava2004"
    )
    lengthening_share = Parameter(
        "1", "Heat taken up per force and lengthening velocity.", default=0.157, bounds=(0, 10), source="bhargava2004"
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
        mass = muscle_mass(p)
        quarter = 0.5 * math.pi * min(1.0, max(0.0, u.excitation))
        slow, fast = p.slow_twitch * math.sin(quarter), (1 - p.slow_twitch) * (1 - math.cos(quarter))
        length = u.normalized_fiber_length
        reach = max(0.5, length) if length < 1 else max(0.0, 3 - 2 * length)
        active = p.slow_activation_heat * slow + p.fast_activation_heat * fast
        maintained = reach * (p.slow_maintenance_heat * slow + p.fast_maintenance_heat * fast)
        if u.fiber_velocity <= 0:
            isometric = u.activation * u.normalized_isometric_force * p.max_isometric_force
            shortening = -(p.isometric_share * isometric + p.total_share * u.force) * u.fiber_velocity
        else:
            shortening = -p.lengthening_share * u.force * u.fiber_velocity
        y.work = -u.fiber_force * u.fiber_velocity
        heat = max(mass * p.least_heat, mass * (active + maintained) + shortening)
        y.heat = max(heat, -y.work)
        y.power = y.heat + y.work
