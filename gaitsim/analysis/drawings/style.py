"""One look for all figures, and how axes are called."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Okabe & Ito's palette without its yellow, which is too light for a line on white.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
LINES = ("-", "--", "-.", ":")
GREY = "#777777"
FONT = 9  # points
COLUMN = 6.0  # inches: a text column on a page, and on a screen at 100 %
DPI = 150
_LEGEND_LETTERS = 56  # in one row, also of a figure drawn for a telephone
_MEANT = {"N m": "moment", "J": "energy"}  # one dimension, two quantities


def panels(rows: int = 1, columns: int = 1, height: float = 2.2, share: bool = False) -> tuple[Figure, list[Axes]]:
    """A figure as wide as a column and its panels, row by row; `height` of one in inches.

    Args:
        share: The panels of a column have one horizontal axis, named at the lowest. Needs no display.
    """
    from cycler import cycler
    from matplotlib.figure import Figure

    made = Figure(figsize=(COLUMN, 0.4 + height * rows), layout="constrained", dpi=DPI)
    grid = made.subplots(rows, columns, squeeze=False, sharex="col" if share else "none")
    found = list(grid.flat)
    for axes in found:
        axes.set_prop_cycle(cycler(color=PALETTE))
        axes.grid(alpha=0.3, linewidth=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        axes.tick_params(labelsize=FONT - 1)
        axes.title.set_size(FONT)
        axes.xaxis.label.set_size(FONT)
        axes.yaxis.label.set_size(FONT)
    return made, found


def look(number: int) -> dict[str, Any]:
    """Colour and stroke of the n-th line, from 0; 28 of them differ."""
    return {"color": PALETTE[number % len(PALETTE)], "linestyle": LINES[number // len(PALETTE) % len(LINES)]}


def legend(axes: Axes, **options: Any) -> None:
    """A legend in the common look, where it hides least."""
    axes.legend(**({"fontsize": FONT - 1, "framealpha": 0.85, "loc": "best"} | options))


def above(axes: Axes) -> None:
    """A legend above a panel, where it hides nothing, in as many columns as its longest word allows."""
    handles, labels = axes.get_legend_handles_labels()
    longest = max((len(label) for label in labels), default=1)
    columns = max(1, min(len(handles), _LEGEND_LETTERS // (longest + 6)))
    legend(axes, loc="lower left", bbox_to_anchor=(0, 1), ncols=columns, frameon=False, borderaxespad=0.1)


def whole_numbers(axes: Axes) -> None:
    """Ticks of the horizontal axis at whole numbers only."""
    from matplotlib.ticker import MaxNLocator

    axes.xaxis.set_major_locator(MaxNLocator(integer=True))


def labelled(name: str, unit: str) -> str:
    """What an axis is called: a name and its unit, a dash for a plain number."""
    return f"{name} ({shown_unit(unit)})"


def quantity(unit: str) -> str:
    """What a unit measures, in words: force, angle; a plain number is a value."""
    from gaitsim.units import parse_unit

    if unit in _MEANT:
        return _MEANT[unit]
    dimension = parse_unit(unit).dimension
    words = str(dimension).removeprefix("an ").removeprefix("a ")
    return "value" if dimension.plain else words.removeprefix("quantity of ")


def shown_unit(unit: str) -> str:
    """A unit as it is read: N m/rad becomes N·m/rad, m/s^2 becomes m/s²."""
    if unit in ("", "1"):
        return "–"
    raised = {"^2": "²", "^3": "³", "^-1": "⁻¹", "^-2": "⁻²"}
    for plain, high in raised.items():
        unit = unit.replace(plain, high)
    return unit.replace(" ", "·")
