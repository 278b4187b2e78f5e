"""Panels over the gait cycle: mean and band of each leg, with people's data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gaitsim.analysis.drawings.style import FONT, LINES, PALETTE
from gaitsim.analysis.gait.legs import PERCENT, Cycle, Leg
from gaitsim.analysis.gait.norms import Norm

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LINE: dict[str, dict[str, Any]] = {
    "l": {"color": PALETTE[0], "linestyle": LINES[0]},
    "r": {"color": PALETTE[1], "linestyle": LINES[1]},
}
PEOPLE = PALETTE[2]  # not grey, because the bands of two legs are grey where they overlap
BAND = "Bands of a leg's colour: one standard deviation over its strides."


def strides_text(legs: Sequence[Leg], until: str = "touchdown") -> str:
    """Which strides are shown, and how, in words."""
    counts = " and ".join(f"{len(leg.strides)} strides of the {leg.name} leg" for leg in legs)
    return f"mean of {counts}, from {min(leg.touchdowns[0] for leg in legs):.3g} s on, from touchdown to {until}"


def draw_band(panel: Axes, leg: Leg, cycle: Cycle, factor: float = 1.0) -> None:
    """Draw the mean of a leg and one standard deviation around it."""
    style = LINE[leg.side]
    mean, deviation = factor * cycle.mean, abs(factor) * cycle.deviation
    panel.fill_between(PERCENT, mean - deviation, mean + deviation, color=style["color"], alpha=0.18, linewidth=0)
    panel.plot(PERCENT, mean, label=leg.name, **style)
    panel.set_xlim(0, 100)


def draw_cycle(panel: Axes, leg: Leg, cycle: Cycle, factor: float = 1.0) -> None:
    """Draw mean and band over the gait cycle, and a thin line where the leg leaves the ground."""
    draw_band(panel, leg, cycle, factor)
    lift = 100 * float(np.mean(leg.share(leg.standing)))
    panel.axvline(lift, color=LINE[leg.side]["color"], linestyle=":", linewidth=0.9)


def draw_people(panel: Axes, norm: Norm, factor: float) -> None:
    """Draw people's mean, with the band if it is known."""
    if norm.deviation is not None:
        low, high = (factor * edge for edge in norm.band)
        panel.fill_between(PERCENT, low, high, color=PEOPLE, alpha=0.25, linewidth=0)
    panel.plot(PERCENT, factor * norm.mean, color=PEOPLE, linewidth=1, label="people")


def name_lines(figure: Figure, panel: Axes) -> None:
    """Add one legend for all panels, above them."""
    handles, labels = panel.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper right", ncols=len(labels), frameon=False, fontsize=FONT)
