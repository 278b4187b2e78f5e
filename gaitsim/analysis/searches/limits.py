"""Figures of limits that were found over another number; a polar one over an angle."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import COLUMN, DPI, FONT, PALETTE, labelled, legend, panels
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.searches.sweep import places
from gaitsim.results.rows import outcome_of, read_rows
from gaitsim.results.until import until_of
from gaitsim.spec.study import column, span
from gaitsim.units import parse_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_SIDE = 4.6  # inches: a polar figure


@dataclass(frozen=True)
class LimitOver:
    """A limit at one value of the other number.

    Attributes:
        over: That value, as text.
        last: The last value that holds, in the unit of the range; nan if there is none.
        open: Whether all values hold that were tried.
    """

    over: str
    last: float
    open: bool


def limit_figures(replay: Replay) -> list[Drawing]:
    """A figure for each number whose limit was found over another number; none for other results."""
    asked = replay.manifest.get("limit") if replay.folder is not None else None
    if not isinstance(asked, Mapping) or not asked.get("over"):
        return []
    across, values = column(str(asked["over"]), "--over")
    at = places(values)
    drawings = []
    for text in asked["vary"]:
        address, ends = span(text)
        found = _found(replay, asked, address, ends.first, across, values)
        drawings.append(_figure(address, ends.unit, across, found, at))
    return drawings


def _found(
    replay: Replay, asked: Mapping[str, Any], address: str, first: float, across: str, values: Sequence[str]
) -> list[LimitOver]:
    """The limit at each value of the other number."""
    assert replay.folder is not None
    until, step = until_of(asked["until"], replay.model), replay.model.simulate.step
    found = []
    for value in values:
        runs = [r for r in read_rows(replay.folder) if address in r["settings"] and r["settings"].get(across) == value]
        at = places([run["settings"][address] for run in runs])
        if at is None:
            continue
        order = np.argsort(np.abs(at[0] - first), kind="stable")
        outcomes = [outcome_of(runs[i], step) for i in order]
        held = [until.holds(outcome, outcomes[0]) for outcome in outcomes]
        count = held.index(False) if False in held else len(held)
        found.append(LimitOver(value, float(at[0][order[count - 1]]) if count else math.nan, count == len(held)))
    return found


def _figure(address: str, unit: str, across: str, found: Sequence[LimitOver], at: tuple[Any, str] | None) -> Drawing:
    sizes = np.array([one.last for one in found])
    free = np.array([one.open for one in found])
    angle = at is not None and parse_unit(at[1]).dimension == parse_unit("deg").dimension
    if at is not None and angle:
        figure, axes = _polar()
        turn = np.asarray(at[0]) * parse_unit(at[1]).factor
        order = np.argsort(turn % (2 * np.pi), kind="stable")
        ring = np.append(order, order[0]) if len(order) > 2 else order
        axes.plot(turn[ring], np.abs(sizes[ring]), "o-", color=PALETTE[0], markersize=4)
        axes.fill(turn[ring], np.abs(sizes[ring]), color=PALETTE[0], alpha=0.12)
        axes.plot(turn[free], np.abs(sizes[free]), "^", color=PALETTE[1], label="holds to the end of its range")
        axes.set_title(labelled(address, unit), fontsize=FONT, pad=14)
        axes.set_ylim(0, None)
    else:
        figure, (axes,) = panels()
        where = np.asarray(at[0]) if at is not None else np.arange(len(found))
        axes.plot(where, sizes, "o-", markersize=4)
        axes.plot(where[free], sizes[free], "^", label="holds to the end of its range")
        axes.set_ylabel(labelled(address, unit))
        axes.set_xlabel(labelled(across, at[1]) if at is not None else across)
        if at is None:
            axes.set_xticks(where, [one.over for one in found])
    if free.any():
        legend(axes, **({"loc": "upper left", "bbox_to_anchor": (-0.12, 1.12)} if angle else {}))
    caption = f"The last {address} that holds, at {len(found)} values of {across}"
    ways = ": 0 deg is up, and angles grow to the left" if angle else ""
    return Drawing(f"limit_{address}", f"Limit of {address} over {across}", f"{caption}{ways}.", figure)


def _polar() -> tuple[Figure, Axes]:
    """A polar figure whose angles begin at the top and grow to the left, as seen from above."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=(min(COLUMN, _SIDE), _SIDE), layout="constrained", dpi=DPI)
    axes: Any = figure.add_subplot(projection="polar")
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(1)
    axes.grid(alpha=0.3, linewidth=0.6)
    axes.tick_params(labelsize=FONT - 1)
    axes.yaxis.set_major_locator(MaxNLocator(5))
    return figure, axes
