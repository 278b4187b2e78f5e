"""The curves of De Groote et al. (2016) that do not depend on how the tendon is modelled."""

import math

LEAST, MOST = math.exp(0.2 * 4 / 0.6), math.exp(1.6 * 4 / 0.6)  # passive elasticity at its ends
# Dimensionless. The digits of degroote2016 are rounded; those of OpenSim's DeGrooteFregly2016Muscle are not: f_l is 1
# at 1, and f_v is 0 at -1 and 1 at 0.
FIRST = (0.8150671134243542, 1.055033428970575, 0.162384573599574, 0.063303448465465)
SECOND = (0.433004984392647, 0.716775413397760, -0.029947116970696, 0.200356847296188)
THIRD = (0.1, 1.0, 0.353553390593274, 0.0)
D_1, D_2, D_3, D_4 = -0.3211346127989808, -8.149, -0.374, 0.8825327733249912


def gaussian(length, coefficients):
    """b_1 exp(-((l - b_2) / (b_3 + b_4 l))^2 / 2)."""
    height, center, width, widening = coefficients
    offset = (length - center) / (width + widening * length)
    return height * math.exp(-0.5 * offset * offset)


def active_force(length):
    """f_l: three Gaussians whose width grows with the length."""
    return gaussian(length, FIRST) + gaussian(length, SECOND) + gaussian(length, THIRD)


def force_velocity(velocity):
    """f_v = d_1 asinh(d_2 v + d_3) + d_4, v in v_max."""
    return D_1 * math.asinh(D_2 * velocity + D_3) + D_4


def passive_force(length):
    """f_PE: exponential, 0 at 0.2 and 1 at 1.6 optimal lengths."""
    return max(0.0, math.exp(length * 4 / 0.6) - LEAST) / (MOST - LEAST)


def passive_energy(length):
    """Integral of f_PE over the length."""
    long = max(0.2, length)
    return (0.15 * (math.exp(long * 4 / 0.6) - LEAST) - LEAST * (long - 0.2)) / (MOST - LEAST)
