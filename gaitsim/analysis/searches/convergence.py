"""Figures of a search: the scores of its generations, and the tuned numbers within their bounds."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import FONT, GREY, PALETTE, above, labelled, panels, shown_unit, whole_numbers
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay
from gaitsim.optimization.evaluation import Evaluation
from gaitsim.optimization.journal import evaluations_in
from gaitsim.results.manifest import format_of
from gaitsim.units import parse_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ROW = 0.5  # inches a tuned number
_LABEL_SPACE = 1.25  # margin above the scores, as a share of their range


@dataclass(frozen=True)
class TunedParameter:
    """One row of parameters.csv in its unit; nan for unknown values."""

    address: str
    unit: str
    low: float
    high: float
    start: float
    best: float
    mean: float
    std: float

    def share(self, value: float) -> float:
        """The position of a value between the bounds: 0 at the lower, 1 at the upper bound."""
        return (value - self.low) / (self.high - self.low)


@dataclass(frozen=True)
class Scores:
    """The scores of the candidates of each generation, without failed ones. Generation 0 is the start."""

    generations: tuple[int, ...]
    scores: tuple[Floats, ...]
    failed: int

    def summary(self, share: float) -> Floats:
        """A quantile of the scores of each generation; nan if all candidates failed."""
        return np.array([np.quantile(s, share) if s.size else math.nan for s in self.scores])

    @property
    def best_so_far(self) -> Floats:
        lowest = [s.min(initial=math.inf) for s in self.scores]
        best = np.minimum.accumulate(np.array(lowest))
        return np.where(np.isfinite(best), best, math.nan)

    @property
    def deviation(self) -> Floats:
        """The standard deviation of the scores of each generation."""
        return np.array([float(np.std(s)) if s.size else math.nan for s in self.scores])


def scores_of(evaluations: list[Evaluation]) -> Scores:
    """The scores of a search by generation."""
    generations = sorted({e.candidate.generation for e in evaluations})
    costs = [[e.cost for e in evaluations if e.candidate.generation == g and not e.failed] for g in generations]
    scores = tuple(np.array(each, dtype=np.float64) for each in costs)
    return Scores(tuple(generations), scores, sum(e.failed for e in evaluations))


def tuned_in(folder: Path, manifest: Mapping[str, Any]) -> list[TunedParameter]:
    """Read the tuned numbers of a result.

    Args:
        folder: The result.
        manifest: Its manifest.

    Returns:
        The numbers in the units of parameters.csv; empty if that is missing or incomplete.
    """
    path = folder / "parameters.csv"
    if not path.is_file():
        return []
    names = ("low", "high", "start", "best", "mean", "std")
    found = []
    with path.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if None in row.values():  # a torn line
                continue
            try:
                numbers = {name: float(row[name]) if row[name] else math.nan for name in names}
                # The first format has SI numbers beside the unit of the declaration.
                of = parse_unit(row["unit"]).of if format_of(manifest) == 1 else float
                found.append(
                    TunedParameter(row["address"], row["unit"], **{name: of(n) for name, n in numbers.items()})
                )
            except (KeyError, TypeError, ValueError):  # UnknownUnit is a ValueError
                continue
    return found


def convergence_figures(replay: Replay) -> list[Drawing]:
    """The scores of a search; none for other results."""
    if replay.folder is None or replay.manifest.get("kind") != "optimize":
        return []
    evaluations = evaluations_in(replay.folder)
    if all(e.failed for e in evaluations):
        return []
    return [_by_generation(scores_of(evaluations)), _by_evaluation(evaluations)]


def tuned_figures(replay: Replay) -> list[Drawing]:
    """The tuned numbers of a search within their bounds; none for other results."""
    tuned = [t for t in tuned_in(replay.folder, replay.manifest) if t.high > t.low] if replay.folder else []
    return [_within_bounds(tuned)] if tuned else []


def _ceiling(scores: Floats) -> float:
    """The upper end of the axis of scores: most of the middle scores; failures can cost a hundred times more."""
    low, middle = float(scores.min()), float(np.quantile(scores, 0.75))
    return max(middle + _LABEL_SPACE * (middle - low), low + 1e-9 * abs(low) + 1e-12)


def _by_generation(scores: Scores) -> Drawing:
    figure, (axes, deviation) = panels(2, 1, height=2.1, share=True)
    numbers = np.array(scores.generations)
    mark = "o" if len(numbers) < 40 else ""
    axes.fill_between(numbers, scores.summary(0.25), scores.summary(0.75), color=PALETTE[0], alpha=0.2, linewidth=0)
    axes.plot(numbers, scores.summary(0.5), marker=mark, markersize=3, color=PALETTE[0], label="median")
    axes.plot(numbers, scores.summary(0), marker=mark, markersize=3, color=PALETTE[2], label="best of the generation")
    axes.step(numbers, scores.best_so_far, where="post", color=PALETTE[1], linewidth=1.8, label="best so far")
    axes.set_ylim(top=_ceiling(np.concatenate(scores.scores)))
    axes.set_ylabel(labelled("score", "1"))
    above(axes)
    wide = np.where(scores.deviation > 0, scores.deviation, math.nan)
    deviation.plot(numbers, wide, marker="o" if len(numbers) < 40 else "", markersize=3, color=GREY)
    if np.isfinite(wide).any() and np.nanmax(wide) > 10 * np.nanmin(wide):
        deviation.set_yscale("log")
    deviation.set_ylabel(labelled("standard deviation", "1"))
    deviation.set_xlabel(labelled("generation", "1"))
    whole_numbers(deviation)
    failed = f" {scores.failed} candidates failed and have no score." if scores.failed else ""
    caption = (
        "Score of each generation; it is a cost, so lower is better, and its unit is the objective's own. Band: the "
        "middle half of the candidates. Generation 0 is the start. Below: the standard deviation of the "
        f"scores.{failed}"
    )
    return Drawing("convergence", "Convergence", caption, figure)


def _by_evaluation(evaluations: list[Evaluation]) -> Drawing:
    costs = np.array([e.cost for e in evaluations])
    numbers = np.arange(1, len(costs) + 1)
    known = np.isfinite(costs)
    best = np.minimum.accumulate(costs)
    ceiling = _ceiling(costs[known])
    figure, (axes,) = panels(1, 1, height=2.6)
    inside = known & (costs <= ceiling)
    axes.plot(numbers[inside], costs[inside], "o", color=PALETTE[0], markersize=3, alpha=0.5, label="candidate")
    beyond = known & ~inside
    lost = ~known
    axes.step(numbers[np.isfinite(best)], best[np.isfinite(best)], where="post", color=PALETTE[1], label="best so far")
    low = float(costs[known].min())
    top = ceiling + 0.1 * (ceiling - low)
    axes.plot(numbers[beyond], np.full(beyond.sum(), ceiling), "^", color=GREY, markersize=4, label="worse than shown")
    axes.plot(numbers[lost], np.full(lost.sum(), top), "x", color="black", markersize=4, label="failed")
    for line, present in zip(axes.lines[-2:], (beyond.any(), lost.any()), strict=True):
        line.set_label(line.get_label() if present else "_none")
    axes.set_ylim(low - 0.08 * (top - low), top + 0.05 * (top - low))
    axes.set_xlabel(labelled("evaluation", "1"))
    axes.set_ylabel(labelled("score", "1"))
    above(axes)
    caption = (
        f"Score of each of the {len(costs)} candidates in the order of the search; lower is better. "
        f"{int(beyond.sum())} are worse than shown, {int(lost.sum())} failed. Best: {low:.5g}."
    )
    return Drawing("evaluations", "Every evaluation", caption, figure)


def _within_bounds(tuned: list[TunedParameter]) -> Drawing:
    figure, (axes,) = panels(1, 1, height=_ROW * len(tuned) + 0.6)
    for row, each in enumerate(tuned):
        _bar(axes, row, each, named=row == 0)
    axes.set_ylim(len(tuned) - 0.35, -0.6)
    axes.set_xlim(-0.02, 1.02)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.grid(False)
    axes.set_xlabel("place between the bounds (0: lower, 1: upper)")
    above(axes)
    edge = [t.address for t in tuned if min(t.share(t.best), 1 - t.share(t.best)) < 0.01]
    bounds = f" At a bound: {', '.join(edge)}." if edge else ""
    caption = (
        "Tuned numbers within the bounds of the search, which stand below the ends of the bars; the best value stands "
        f"on the right. Mean and standard deviation: the better half of the last generation.{bounds}"
    )
    return Drawing("tuned_parameters", "Tuned parameters within their bounds", caption, figure)


def _bar(axes: Axes, row: int, each: TunedParameter, named: bool) -> None:
    """The range of one number with its start, best value and mean."""
    axes.barh(row, 1, height=0.22, color=GREY, alpha=0.18)
    if math.isfinite(each.mean):
        low, high = (each.share(each.mean + sign * each.std) for sign in (-1, 1))
        ends = [max(0.0, low), min(1.0, high)]
        axes.plot(ends, [row, row], color=PALETTE[0], linewidth=5, alpha=0.5, solid_capstyle="butt")
        mean: dict[str, Any] = {"color": PALETTE[0], "markersize": 11, "markeredgewidth": 2, "linestyle": "none"}
        axes.plot(each.share(each.mean), row, marker="|", label="mean ± std" if named else None, **mean)
    start: dict[str, Any] = {"color": "black", "markerfacecolor": "white", "markersize": 6, "linestyle": "none"}
    axes.plot(each.share(each.start), row, marker="o", label="start" if named else None, **start)
    best: dict[str, Any] = {"color": PALETTE[1], "markersize": 6, "linestyle": "none"}
    axes.plot(each.share(each.best), row, marker="D", label="best" if named else None, **best)
    unit = "" if each.unit == "1" else f" {shown_unit(each.unit)}"
    axes.text(0, row - 0.18, each.address, fontsize=FONT - 1, va="bottom")
    axes.text(1, row - 0.18, f"{each.best:.5g}{unit}", fontsize=FONT - 1, va="bottom", ha="right", color=PALETTE[1])
    for place, bound, side in ((0, each.low, "left"), (1, each.high, "right")):
        axes.text(place, row + 0.17, f"{bound:.5g}{unit}", fontsize=FONT - 2, va="top", ha=side, color=GREY)
