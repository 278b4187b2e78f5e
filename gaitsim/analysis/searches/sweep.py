"""Figures of a study: every metric over what was varied, with known values."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import GREY, PALETTE, above, labelled, panels
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.reference import metric_over
from gaitsim.analysis.replays.replay import Replay
from gaitsim.results.rows import read_rows
from gaitsim.units import UnknownUnit, parse_quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LINES = 6  # a second varied number with more values than this gets no line for each


@dataclass(frozen=True)
class Study:
    """The rows of a study: settings as text, and metrics, nan where there are none."""

    rows: tuple[Mapping[str, str], ...]
    metrics: tuple[Mapping[str, float], ...]
    statuses: tuple[str, ...]

    @property
    def varied(self) -> list[str]:
        """The addresses that differ between rows."""
        every = dict.fromkeys(address for row in self.rows for address in row)
        return [a for a in every if len({row.get(a) for row in self.rows}) > 1]

    def column(self, metric: str) -> Floats:
        return np.array([row.get(metric, math.nan) for row in self.metrics])


def study_in(folder: Path) -> Study | None:
    """The study of a result; None if the result has one run only."""
    rows = read_rows(folder)
    if len(rows) < 2:
        return None
    metrics = [{n: math.nan if v is None else float(v) for n, v in row["metrics"].items()} for row in rows]
    statuses = tuple(str(row["status"]) for row in rows)
    return Study(tuple(dict(row["settings"]) for row in rows), tuple(metrics), statuses)


def study_of(replay: Replay) -> Study | None:
    """The study that a replay belongs to; None for other runs."""
    if replay.folder is None or replay.manifest.get("kind") != "run":
        return None
    study = study_in(replay.folder)
    return study if study is not None and study.varied else None


def places(texts: Sequence[str | None]) -> tuple[Floats, str] | None:
    """Texts such as "2.5" or "3 ms" as numbers in the unit of the first; None if one is not a number."""
    numbers, units = [], []
    for text in texts:
        try:
            quantity = parse_quantity(text) if text is not None else None
        except UnknownUnit:
            quantity = None
        if quantity is None:
            return None
        numbers.append(quantity.value)
        units.append(quantity.unit)
    if len({unit.dimension for unit in units}) > 1:
        return None
    return np.array(numbers) / units[0].factor, units[0].text


def sweep_figures(replay: Replay) -> list[Drawing]:
    """A figure for each measure: its metrics over the varied number; none without a study."""
    study = study_of(replay)
    if study is None:
        return []
    units, groups = replay.model.metrics, _by_measure(replay, study)
    return [_figure(replay, study, measure, names, units) for measure, names in groups.items()]


def _by_measure(replay: Replay, study: Study) -> dict[str, list[str]]:
    """The metrics that some row has, by their measure."""
    groups: dict[str, list[str]] = {}
    for part in replay.model.parts:
        own = [n for n in replay.model.metrics if n == part.address or n.startswith(f"{part.address}.")]
        known = [n for n in own if part.measure and np.isfinite(study.column(n)).any()]
        if known:
            groups[part.address] = known
    return groups


def _figure(replay: Replay, study: Study, measure: str, names: list[str], units: Mapping[str, str]) -> Drawing:
    across = study.varied[0]
    found = places([row.get(across) for row in study.rows])
    at, unit = found if found else (np.arange(len(study.rows), dtype=np.float64), "")
    figure, panel = panels(len(names), 1, height=1.9, share=True)
    sources: dict[str, None] = {}
    for axes, name in zip(panel, names, strict=True):
        _lines(axes, study, at, study.column(name))
        known = metric_over(replay, across, name) if unit == "1" else None
        if known is not None:
            axes.plot(*known.points, "s", color=PALETTE[2], markerfacecolor="none", label="reference", zorder=4)
            sources[known.source] = None
        axes.set_ylabel(labelled(_short(name, measure), units[name]))
    _name_horizontal(panel[-1], study, across, at, unit, settings=found is None)
    _mark_lost(panel[-1], study, at)
    if len(panel[0].get_legend_handles_labels()[0]) > 1:
        above(panel[0])
    lost = [status for status in study.statuses if status != "completed"]
    how = ", ".join(sorted(set(lost)))
    losses = f" {len(lost)} of the {len(study.rows)} rows did not complete (×: {how})." if lost else ""
    source = f" Squares: {'; '.join(sources)}." if sources else ""
    caption = f"{', '.join(names)} over {', '.join(study.varied)}, {len(study.rows)} rows.{losses}{source}"
    return Drawing(f"sweep_{measure}", f"{measure} over {across}", caption, figure)


def _short(name: str, measure: str) -> str:
    return name if name == measure else name.removeprefix(f"{measure}.")


def _lines(axes: Axes, study: Study, at: Floats, values: Floats) -> None:
    """One line, or one for each value of the second varied number."""
    second = study.varied[1] if len(study.varied) > 1 else None
    kinds: list[Any] = list(dict.fromkeys(row.get(second) for row in study.rows)) if second else [None]
    apart = len(study.varied) == 2 and len(kinds) <= _LINES
    for kind in kinds if apart else [None]:
        mine = np.array([not apart or row.get(second or "") == kind for row in study.rows])
        order = np.argsort(at[mine], kind="stable")
        style = "o-" if apart or second is None else "o"
        label = f"{second} = {kind}" if apart else "this study"
        axes.plot(at[mine][order], values[mine][order], style, markersize=4, label=label)


def _name_horizontal(axes: Axes, study: Study, across: str, at: Floats, unit: str, settings: bool) -> None:
    if settings:
        texts = [", ".join(row.get(a, "–") for a in study.varied) for row in study.rows]
        axes.set_xticks(at, texts, rotation=30, ha="right")
        axes.set_xlabel(", ".join(study.varied))
    else:
        axes.set_xlabel(labelled(across, unit))


def _mark_lost(axes: Axes, study: Study, at: Floats) -> None:
    """Crosses on the lower edge for rows that did not complete."""
    lost = np.array([status != "completed" for status in study.statuses])
    if lost.any():
        edge = axes.get_xaxis_transform()
        axes.plot(at[lost], np.zeros(lost.sum()), "x", color=GREY, transform=edge, clip_on=False, zorder=5)
