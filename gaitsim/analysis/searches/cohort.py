"""Figures of a cohort: how each body ended with each device, and metrics over what is varied."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import FONT, GREY, PALETTE, above, labelled, panels
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.searches.sweep import places

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLOURS = {"completed": PALETTE[2], "retuned": PALETTE[5], "stopped": PALETTE[1], "failed": GREY}
_HIGH = 0.17  # inches for a body


@dataclass(frozen=True)
class Outline:
    """A row for figures: the name of the body, its settings, how it ended, and its metrics."""

    body: str
    settings: Mapping[str, str]
    ending: str
    metrics: Mapping[str, float]

    def value(self, metric: str) -> float:
        """A metric of a completed row; nan for any other row."""
        return self.metrics.get(metric, math.nan) if self.ending in ("completed", "retuned") else math.nan


@dataclass(frozen=True)
class _Grid:
    """The rows of a cohort as a grid of bodies and devices, and the addresses that differ between them."""

    bodies: tuple[tuple[Outline, ...], ...]
    own: tuple[str, ...]
    varied: tuple[str, ...]

    @property
    def devices(self) -> tuple[Outline, ...]:
        return self.bodies[0]


def cohort_figures(rows: Sequence[Outline], metrics: Sequence[str], units: Mapping[str, str]) -> list[Drawing]:
    """The map of how rows ended, and a figure for each metric.

    Args:
        rows: The rows, body by body, each with the same devices.
    """
    grid = _grid(rows)
    return [_endings(grid), *(_metric(grid, name, units[name]) for name in metrics)]


def _grid(rows: Sequence[Outline]) -> _Grid:
    names = list(dict.fromkeys(row.body for row in rows))
    bodies = tuple(tuple(row for row in rows if row.body == name) for name in names)
    addresses = list(dict.fromkeys(address for row in rows for address in row.settings))
    varied = tuple(a for a in addresses if len({row.settings.get(a) for row in bodies[0]}) > 1)
    own = tuple(a for a in addresses if a not in varied and len({row.settings.get(a) for row in rows}) > 1)
    return _Grid(bodies, own, varied)


def _endings(grid: _Grid) -> Drawing:
    count = len(grid.bodies)
    figure, (axes,) = panels(1, 1, height=max(1.4, 0.6 + _HIGH * count))
    axes.grid(visible=False)
    for ending in dict.fromkeys(row.ending for body in grid.bodies for row in body):
        at = [(x, y) for y, body in enumerate(grid.bodies) for x, row in enumerate(body) if row.ending == ending]
        across, along = zip(*at, strict=True)
        label = f"{ending} ({len(at)})"
        axes.scatter(across, along, marker="s", s=60, color=_COLOURS.get(ending, PALETTE[6]), label=label)
    axes.set_yticks(range(count), [_row_label(body[0], grid.own) for body in grid.bodies], fontsize=FONT - 3)
    axes.set_ylim(count - 0.4, -0.6)
    axes.set_xlim(-0.6, len(grid.devices) - 0.4)
    devices = [", ".join(_values_text(row, grid.varied)) for row in grid.devices]
    axes.set_xticks(range(len(devices)), devices, fontsize=FONT - 3)
    axes.set_xlabel(", ".join(grid.varied))
    above(axes)
    rows = count * len(grid.devices)
    caption = (
        f"How the runs of {count} bodies ended, {rows} in all. retuned: it completes with tuned values of its own."
    )
    return Drawing("endings", "How each body ended", caption, figure)


def _metric(grid: _Grid, metric: str, unit: str) -> Drawing:
    """A metric over the device, with one line for each body; without devices, over what differs between bodies."""
    figure, (axes,) = panels(1, 1, height=3.0)
    over = [body[0] for body in grid.bodies] if not grid.varied else list(grid.devices)
    address = (grid.varied or grid.own or ("body",))[0]
    found = places([row.settings.get(address) for row in over])
    at, name = found if found else (np.arange(len(over), dtype=np.float64), "")
    if grid.varied:
        _lines(figure, axes, grid, metric, at)
    else:
        _points(figure, axes, grid, metric, at)
    if found is None:
        axes.set_xticks(at, [row.settings.get(address, row.body) for row in over], rotation=30, ha="right")
    axes.set_xlabel(labelled(address, name) if found else address)
    axes.set_ylabel(labelled(metric, unit))
    each = "One line for each body. " if grid.varied else ""
    again = "Open: tuned again, so that it is another gait. " if grid.varied else ""
    caption = f"{metric} over {address}. {each}{again}Rows that did not complete are left out."
    return Drawing(metric.replace(".", "_"), f"{metric} over {address}", caption, figure)


def _points(figure: Figure, axes: Axes, grid: _Grid, metric: str, at: Floats) -> None:
    """One point for each body, coloured by the second number that differs between bodies."""
    values = [body[0].value(metric) for body in grid.bodies]
    shade = places([body[0].settings.get(grid.own[1]) for body in grid.bodies]) if len(grid.own) > 1 else None
    if shade is None:
        axes.plot(at, values, "o", markersize=4)
        return
    points = axes.scatter(at, values, c=shade[0], s=24, cmap="viridis", zorder=3)
    figure.colorbar(points, ax=axes, label=labelled(grid.own[1], shade[1]))


def _lines(figure: Figure, axes: Axes, grid: _Grid, metric: str, at: Floats) -> None:
    """Draw one line for each body, coloured by the first number that differs between bodies, and their mean."""
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    shade = places([body[0].settings.get(grid.own[0]) for body in grid.bodies]) if grid.own else None
    values = np.array([[row.value(metric) for row in body] for body in grid.bodies])
    scale = Normalize(shade[0].min(), shade[0].max()) if shade else Normalize(0, 1)
    order = np.argsort(at, kind="stable")
    retuned = np.array([[row.ending == "retuned" for row in body] for body in grid.bodies])
    for i, line in enumerate(values):
        colour = colormaps["viridis"](scale(shade[0][i])) if shade else PALETTE[0]
        axes.plot(at[order], line[order], "o-", color=colour, markersize=3, linewidth=0.9)
        axes.plot(at[retuned[i]], line[retuned[i]], "o", color=colour, markersize=6, markerfacecolor="white", zorder=4)
    whole = values[np.isfinite(values).all(axis=1) & ~retuned.any(axis=1)]
    if retuned.any():
        axes.plot([], [], "o", color=GREY, markersize=6, markerfacecolor="white", label="tuned again")
    if len(whole):
        axes.plot(
            at[order],
            whole.mean(axis=0)[order],
            "k-",
            linewidth=2.2,
            label=f"mean of {len(whole)} bodies that need no tuning",
        )
        above(axes)
    if shade:
        figure.colorbar(ScalarMappable(scale, "viridis"), ax=axes, label=labelled(grid.own[0], shade[1]))


def _row_label(row: Outline, own: Sequence[str]) -> str:
    return ", ".join([row.body, *_values_text(row, own)])


def _values_text(row: Outline, addresses: Sequence[str]) -> list[str]:
    return [row.settings.get(address, "") for address in addresses]
