"""Figures of draws: the distribution of each metric when every tuned number is changed a little."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import FONT, GREY, PALETTE, labelled, panels
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay
from gaitsim.model import headline_metrics
from gaitsim.results.rows import read_rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COLUMNS = 2
_HEIGHT = 1.15  # inches


@dataclass(frozen=True)
class Summary:
    """One metric over draws, in its declared unit.

    Attributes:
        count: The number of draws with a value.
    """

    name: str
    mean: float
    least: float
    greatest: float
    count: int


@dataclass(frozen=True)
class DrawResults:
    """The draws of a result: size and seed, how each ended, and its metrics (nan for none)."""

    within: float
    seed: int
    statuses: tuple[str, ...]
    metrics: tuple[Mapping[str, float], ...]

    @property
    def completed(self) -> int:
        return sum(status == "completed" for status in self.statuses)

    @property
    def summary(self) -> str:
        """How many draws completed, and what the draws are, in words."""
        changed = f"every tuned value changed by up to {100 * self.within:g} % (uniform, seed {self.seed})"
        return f"{self.completed} of {len(self.statuses)} draws completed; in each, {changed}"

    def column(self, metric: str) -> Floats:
        return np.array([row.get(metric, math.nan) for row in self.metrics])


def summaries(rows: Sequence[Mapping[str, float]]) -> list[Summary]:
    """Mean, minimum and maximum of every metric over the rows with a finite value; nan if there are none."""
    found = []
    for name in dict.fromkeys(name for row in rows for name in row):
        numbers = [row[name] for row in rows if math.isfinite(row.get(name, math.nan))]
        if numbers:
            found.append(Summary(name, math.fsum(numbers) / len(numbers), min(numbers), max(numbers), len(numbers)))
        else:
            found.append(Summary(name, math.nan, math.nan, math.nan, 0))
    return found


def drawn_in(folder: Path, manifest: Mapping[str, Any]) -> DrawResults | None:
    """The draws of a result; None for other results."""
    asked = manifest.get("draws")
    if not asked:
        return None
    rows = read_rows(folder)
    metrics = [{n: math.nan if v is None else float(v) for n, v in row["metrics"].items()} for row in rows]
    statuses = tuple(str(row["status"]) for row in rows)
    return DrawResults(float(asked["within"]), int(asked["seed"]), statuses, tuple(metrics))


def draws_of(replay: Replay) -> DrawResults | None:
    """The draws that a replay belongs to; None for other runs."""
    return None if replay.folder is None else drawn_in(replay.folder, replay.manifest)


def draws_figures(replay: Replay) -> list[Drawing]:
    """One figure with a point for each draw, for the main metric of each measure; none for other results."""
    draws = draws_of(replay)
    if draws is None:
        return []
    names = [n for n in headline_metrics(replay.model.metrics) if np.isfinite(draws.column(n)).any()]
    if not names:
        return []
    columns = min(_COLUMNS, len(names))
    figure, grid = panels(math.ceil(len(names) / columns), columns, height=_HEIGHT)
    for axes, name in zip(grid, names, strict=False):
        _strip(axes, draws, draws.column(name))
        axes.set_xlabel(labelled(name, replay.model.metrics[name]))
    for axes in grid[len(names) :]:
        axes.set_visible(False)
    for axes in grid[::columns]:
        axes.set_ylabel("draw")
    lost = "Crosses: stopped before the end. " if "stopped" in draws.statuses else ""
    lost += "What failed has no point. " if "failed" in draws.statuses else ""
    caption = f"{draws.summary}. One point a draw, at its number. {lost}Grey line: mean of all draws."
    return [Drawing("draws", "Every tuned value a little different", caption, figure)]


def _strip(axes: Axes, draws: DrawResults, values: Floats) -> None:
    """The values from left to right by the number of the draw."""
    from matplotlib.ticker import MaxNLocator

    numbers, completed = np.arange(1, values.size + 1), np.array(draws.statuses) == "completed"
    axes.axvline(float(np.nanmean(values)), color=GREY, linewidth=1)
    axes.plot(values[completed], numbers[completed], "o", color=PALETTE[0], markersize=3)
    axes.plot(values[~completed], numbers[~completed], "x", color=PALETTE[1], markersize=4)
    axes.set_ylim(0, values.size + 1)
    axes.locator_params(axis="x", nbins=4)
    axes.ticklabel_format(axis="x", scilimits=(-3, 4), useMathText=True)
    axes.xaxis.offsetText.set_fontsize(FONT - 1)
    axes.yaxis.set_major_locator(MaxNLocator(nbins=3, integer=True))
