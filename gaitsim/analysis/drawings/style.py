"""The common style of all figures, and the names of axes."""

from __future__ import annotations

from collections.abc import Collection
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
_ZERO = 1e-9  # in the unit of a signal: what is smaller counts as zero
_ROUNDING = 1e-6  # of the largest value: a signal that varies less counts as constant
_MEANT = {"N m": "moment", "J": "energy"}  # one dimension, two quantities


def panels(rows: int = 1, columns: int = 1, height: float = 2.2, share: bool = False) -> tuple[Figure, list[Axes]]:
    """Make a figure with panels. It needs no display.

    Args:
        rows: The number of rows.
        columns: The number of columns.
        height: The height of one panel, in inches.
        share: Whether the panels of a column share one horizontal axis, labelled at the lowest panel.

    Returns:
        The figure and its axes, row by row.
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
        place_exponent(axes, FONT - 1)
        axes.title.set_size(FONT)
        axes.xaxis.label.set_size(FONT)
        axes.yaxis.label.set_size(FONT)
    return made, found


def place_exponent(axes: Axes, size: float) -> None:
    """Place the power of ten of a vertical axis above its numbers, left of where a title or a legend begins.

    Args:
        axes: The panel.
        size: The size of its letters, in points.
    """
    text = axes.yaxis.get_offset_text()
    text.set_fontsize(size)
    text.set_horizontalalignment("right")


def is_constant(low: float, high: float) -> bool:
    """Whether what lies between two values is no more than rounding error."""
    return high - low <= max(_ZERO, _ROUNDING * max(abs(low), abs(high)))


def vertical_limits(low: float, high: float, margin: float = 0.05) -> tuple[float, float]:
    """The ends of a vertical axis that shows a signal and does not magnify its rounding error.

    Args:
        low: The smallest value of the signal.
        high: The largest value of the signal.
        margin: The empty part above and below, relative to the range of the signal.
    """
    if not is_constant(low, high):
        room = margin * (high - low)
    else:
        largest = max(abs(low), abs(high))
        room = 0.5 * largest if largest > _ZERO else 1.0
    return low - room, high + room


def limit_vertical(axes: Axes) -> None:
    """Set the ends of the vertical axis of a panel whose lines are drawn, see `vertical_limits`."""
    low, high = axes.dataLim.intervaly
    if is_constant(low, high):
        axes.set_ylim(*vertical_limits(low, high))


def look(number: int) -> dict[str, Any]:
    """Colour and line style of the n-th line, from 0. The first 28 are different."""
    return {"color": PALETTE[number % len(PALETTE)], "linestyle": LINES[number // len(PALETTE) % len(LINES)]}


def legend(axes: Axes, **options: Any) -> None:
    """Add a legend in the common style, where it covers least."""
    axes.legend(**({"fontsize": FONT - 1, "framealpha": 0.85, "loc": "best"} | options))


def above(axes: Axes) -> None:
    """Add a legend above a panel, where it covers nothing, with as many columns as its longest label allows."""
    _, labels = axes.get_legend_handles_labels()
    legend(axes, loc="lower left", bbox_to_anchor=(0, 1), ncols=columns_of(labels), frameon=False, borderaxespad=0.1)


def columns_of(labels: Collection[str]) -> int:
    """The columns of a legend as wide as the figure, as many as the longest label allows."""
    longest = max(map(len, labels), default=1)
    return max(1, min(len(labels), _LEGEND_LETTERS // (longest + 6)))


def whole_numbers(axes: Axes) -> None:
    """Put the ticks of the horizontal axis at integers only."""
    from matplotlib.ticker import MaxNLocator

    axes.xaxis.set_major_locator(MaxNLocator(integer=True))


def labelled(name: str, unit: str) -> str:
    """The label of an axis: a name and its unit; a dash for a plain number."""
    return f"{name} ({shown_unit(unit)})"


def quantity(unit: str) -> str:
    """The quantity that a unit measures, such as force or angle; "value" for a plain number."""
    from gaitsim.units import parse_unit

    if unit in _MEANT:
        return _MEANT[unit]
    dimension = parse_unit(unit).dimension
    name = str(dimension).removeprefix("an ").removeprefix("a ")
    return "value" if dimension.plain else name.removeprefix("quantity of ")


def shown_unit(unit: str) -> str:
    """A unit for reading: N m/rad becomes N·m/rad, m/s^2 becomes m/s²."""
    if unit in ("", "1"):
        return "–"
    raised = {"^2": "²", "^3": "³", "^-1": "⁻¹", "^-2": "⁻²"}
    for plain, high in raised.items():
        unit = unit.replace(plain, high)
    return unit.replace(" ", "·")
