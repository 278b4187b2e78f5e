import math

from gaitsim.component import Component, Curve, Input, Output, Parameter, Refused

from ._corners import blend, draw, steepness

STEEPEST = 1.0  # of the ground: contacts take it for a plane where they touch it
BESIDE = 0.25  # cells between a row of corners and the x axis: along a row the ground never leans to a side


def corner(amplitude, cell, first, seed, column, row):
    """The height of a corner."""
    return amplitude * draw(seed, column, row) if column * cell >= first else 0.0


def surface(amplitude, cell, first, seed, position, side_position):
    """The height at a place, and how it grows with either position."""
    ahead, beside = position / cell, side_position / cell + BESIDE
    column, row = math.floor(ahead), math.floor(beside)
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
    seed = Parameter(
        "1", "Seed of the heights, a whole number.", default=1, bounds=(0, 1e6), source="definition: any seed"
    )
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
        whole = math.floor(p.seed)
        y.height, y.gradient, y.side_gradient = surface(
            p.amplitude, p.cell, p.first, whole, u.position, u.side_position
        )
        y.slope = math.atan(y.gradient)

    @staticmethod
    def build(p, mj):
        steepest = 3 * p.amplitude / p.cell
        if steepest > STEEPEST:
            rule = f"its slope can reach {steepest:.3g}, and contacts are accurate up to a slope of {STEEPEST:g}"
            raise Refused(f"{rule}; for this amplitude, make cell at least {3 * p.amplitude:.3g} m")
        mj.ground(relief=(surface, (p.amplitude, p.cell, p.first, math.floor(p.seed))))
