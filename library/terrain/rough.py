import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, Refused

# The largest prime of the form 3 k + 2 below 2^26: cubing permutes the numbers below it, and doubles hold every
# product.
PRIME = 67108859.0
STEEPEST = 1.0  # of the ground: contacts take it for a plane where they touch it
BESIDE = 0.25  # cells between a row of corners and the x axis: along a row the ground never leans to a side


def remainder(number):
    """What is left of a whole number, divided by the prime."""
    return number - PRIME * math.floor(number / PRIME)


def near(number):
    """A number within those whose products are exact."""
    return min(1e9, max(-1e9, number))


def draw(seed, column, row):
    """A number between -1 and 1 for a corner: that of one seed is the same in both modes and on any machine."""
    value = remainder(remainder(near(seed) * 12289.0 + near(column) * 40961.0) + remainder(near(row) * 65537.0))
    for salt in range(1, 4):
        value = remainder(remainder(value * value) * value + 1299709.0 * salt)
    return 2 * value / (PRIME - 1) - 1


def blend(share):
    """A smooth step from 0 to 1: level at both ends."""
    return share * share * (3 - 2 * share)


def steepness(share):
    """The derivative of the smooth step."""
    return 6 * share * (1 - share)


def corner(amplitude, cell, first, seed, column, row):
    """The height of a corner."""
    return amplitude * draw(seed, column, row) if column * cell >= first else 0.0


def surface(amplitude, cell, first, seed, position, side_position):
    """The height at a place, and how it grows with either position."""
    ahead, beside = position / cell, side_position / cell + BESIDE
    column, row = ahead // 1, beside // 1
    along, aside = ahead - column, beside - row
    right = corner(amplitude, cell, first, seed, column, row)
    left = corner(amplitude, cell, first, seed, column, row + 1)
    right_step = corner(amplitude, cell, first, seed, column + 1, row) - right
    left_step = corner(amplitude, cell, first, seed, column + 1, row + 1) - left
    across = left + left_step * blend(along) - right - right_step * blend(along)
    height = right + right_step * blend(along) + across * blend(aside)
    step = right_step + (left_step - right_step) * blend(aside)
    return height, step * steepness(along) / cell, across * steepness(aside) / cell


class Rough(Component):
    """Level ground up to a place, then smooth random bumps and hollows without end, forwards and to both sides.

    Corners of square cells have independent heights, uniform between -A and A. Between them the surface is
    smooth, and level at each corner. A walker in the plane walks along one line of the same ground.
    """

    amplitude = Parameter(
        "m",
        "A: the largest height above and depth below level ground.",
        default=0.02,
        bounds=(0, 2),
        source="definition: a choice",
    )
    cell = Parameter(
        "m",
        "Side of a cell, the distance over which heights change.",
        default=0.5,
        bounds=(0.02, 100),
        source="definition: about a step",
    )
    first = Parameter(
        "m",
        "Position before which corners are level.",
        default=1,
        bounds=(-1000, 1000),
        source="definition: a start on level ground",
    )
    seed = Parameter("1", "Seed of the heights.", default=1, bounds=(0, 1e6), source="definition: any seed", whole=True)
    position = Input("m", "Position along the ground.", default=0)
    side_position = Input("m", "Position to the left.", default=0)
    height = Output("m", "Height of the ground there.")
    slope = Output("rad", "Slope of the ground in the forward direction.")
    gradient = Output("1", "How much the height grows with the position.")
    side_gradient = Output("1", "How much the height grows to the left.")

    ahead = Curve(
        "height",
        "position",
        (0, 6),
        "Height along the way, for three seeds.",
        each=("seed", (1, 2, 3)),
    )

    @staticmethod
    def output(p, u, x, y):
        y.height, y.gradient, y.side_gradient = surface(
            p.amplitude, p.cell, p.first, p.seed, u.position, u.side_position
        )
        y.slope = math.atan(y.gradient)

    @staticmethod
    def build(p, mj):
        steepest = 3 * p.amplitude / p.cell
        if steepest > STEEPEST:
            rule = f"its slope can reach {steepest:.3g}, and contacts are accurate up to a slope of {STEEPEST:g}"
            raise Refused(f"{rule}; for this amplitude, make cell at least {3 * p.amplitude:.3g} m")
        mj.ground(relief=(surface, (p.amplitude, p.cell, p.first, p.seed)))
