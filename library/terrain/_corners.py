"""Random heights at the corners of square cells, and the smooth surface between them."""

import math

# The largest prime of the form 3 k + 2 below 2^26: cubing permutes the numbers below it, and doubles hold every
# product.
PRIME = 67108859.0


def remainder(number):
    """What is left of a whole number, divided by the prime."""
    return number - PRIME * math.floor(number / PRIME)


def draw(seed, column, row):
    """A number between -1 and 1 for a corner: that of one seed is the same in both modes and on any machine."""
    value = remainder(remainder(seed * 12289.0 + column * 40961.0) + remainder(row * 65537.0))
    for salt in range(1, 4):
        value = remainder(remainder(value * value) * value + 1299709.0 * salt)
    return 2 * value / (PRIME - 1) - 1


def blend(share):
    """A smooth step from 0 to 1: level at both ends."""
    return share * share * (3 - 2 * share)


def steepness(share):
    """The derivative of the smooth step."""
    return 6 * share * (1 - share)
