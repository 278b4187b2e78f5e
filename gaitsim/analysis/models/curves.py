"""The figure of a component's curves, with one panel for each graph."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gaitsim.analysis.drawings.style import FONT, GREY, LINES, labelled, legend, panels
from gaitsim.simulation.curves import Axis, Graph, Line

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw(graphs: Sequence[Graph], file: Path, title: str) -> None:
    """Write a PNG with all graphs, two panels in a row, with angles in degrees.

    Args:
        graphs: The graphs.
        file: The PNG.
        title: The title of the figure.
    """
    columns = min(2, len(graphs))
    rows = -(-len(graphs) // columns)
    figure, axes = panels(rows, columns, height=2.9)
    figure.suptitle(title, fontsize=FONT + 1)
    for each, graph in zip(axes, graphs, strict=False):
        _panel(each, graph)
    for empty in axes[len(graphs) :]:
        empty.set_axis_off()
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file)


def _panel(axes: Axes, graph: Graph) -> None:
    across, up = _degrees(graph.across), _degrees(graph.up)
    for line in graph.lines:
        axes.plot(line.x * across[1], line.y * up[1], label=line.label or None)
    for line, style in zip(graph.meanwhile, cycle(LINES[1:]), strict=False):
        _meanwhile(axes, graph, line, style)
    assumed = ", ".join(f"{name} = {value}" for name, value in graph.assumed.items())
    title = [graph.doc.rstrip("."), *([f"assumed: {assumed}"] if assumed else [])]
    axes.set_title("\n".join(piece for text in title for piece in textwrap.wrap(text, 42)), fontsize=FONT - 1)
    axes.set_xlabel(labelled(graph.across.name, across[0]))
    axes.set_ylabel(labelled(graph.up.name, up[0]))
    axes.margins(x=0)
    axes.locator_params(axis="x", nbins=6)
    if graph.meanwhile or any(line.label for line in graph.lines):
        legend(axes)


def _meanwhile(axes: Axes, graph: Graph, line: Line, style: str) -> None:
    """Draw an input that changes. It is scaled if it does not fit the axis; its label says so."""
    peak = float(np.abs(line.y).max()) or 1.0
    height = max((float(np.nanmax(np.abs(one.y))) for one in graph.lines), default=1.0) or 1.0
    fits = graph.up.unit == "1" and 0.2 < height / peak < 5
    label = line.label if fits else f"{line.label} (to {peak:g}, not to scale)"
    axes.plot(line.x, line.y if fits else line.y * height / peak, color=GREY, linewidth=1, linestyle=style, label=label)


def _degrees(axis: Axis) -> tuple[str, float]:
    """The shown unit and the factor to it: degrees for radians."""
    factors = axis.unit.split("/")
    if factors[0].split()[0] == "rad":
        return axis.unit.replace("rad", "deg", 1), float(np.degrees(1.0))
    return axis.unit, 1.0
