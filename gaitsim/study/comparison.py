"""Comparison of two results or specs: the differences of their models, and their runs in numbers and figures."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from gaitsim.folders import analysis_folder
from gaitsim.results.difference import Change, code_changes, making_changes, model_changes, ordered
from gaitsim.study.products import Products, overlaid_figures
from gaitsim.study.replays import replay_of

if TYPE_CHECKING:
    from gaitsim.analysis.replays.replay import Replay
    from gaitsim.study.listening import Listener
    from gaitsim.study.opened import Opened
    from gaitsim.study.opening import Opening


@dataclass(frozen=True)
class Pair:
    """A number of both runs; nan for a run without it.

    Attributes:
        unit: The unit of both.
    """

    name: str
    unit: str
    first: float
    second: float

    @property
    def difference(self) -> float:
        """The second minus the first."""
        return self.second - self.first

    @property
    def percent(self) -> float:
        """The difference in % of the first; nan if that is 0."""
        return 100 * self.difference / abs(self.first) if self.first else math.nan


@dataclass(frozen=True)
class Comparison:
    """The differences of two runs.

    Attributes:
        labels: Their names.
        changes: The differences of their models.
        metrics: Their metrics and costs.
        gait: Means over strides, of two walkers.
        replays: The runs.
        products: The figures, and what could not be made.
    """

    labels: tuple[str, str]
    changes: Sequence[Change]
    metrics: Sequence[Pair]
    gait: Sequence[Pair]
    replays: Sequence[Replay]
    products: Products


def compared(
    first: Opening, second: Opening, listener: Listener, figures: bool = True, folder: Path | None = None
) -> Comparison:
    """Compare two results or specs. Each is run once more.

    Args:
        first: The first result or spec.
        second: The second one.
        listener: Receives notices about the runs.
        figures: Whether to draw the runs over one another.
        folder: The folder of the figures; None for a folder in the second result, or in analysis/ for a spec.

    Raises:
        BadResult: A folder is not a result, or a result is damaged.
        Untrusted: A result has components that this machine does not trust.
        InvalidSpec: A spec breaks a rule.
        InvalidComponent: A component file breaks the contract.
        Usage: A result is a study, and no run of it is named.
        CannotSave: The figures cannot be written.
    """
    from gaitsim.study.analyses import writable

    pair = [replace(each, candidate="best") if each.names_result else each for each in (first, second)]
    labels = _labels(first.path, second.path)
    both = [opening.open() for opening in pair]
    changes = _changes(both)
    with listener.waiting("running again"):
        replays = [replay_of(opened, o.path, label) for opened, o, label in zip(both, pair, labels, strict=True)]
    for notice in dict.fromkeys(notice for replay in replays for notice in replay.notices):
        listener.say(notice)
    for replay in replays:
        if replay.ending:
            listener.say(f"{replay.label}: {replay.ending}")
    products = Products(Path(), listener=listener)
    if figures:
        products.folder = writable(folder or _folder(second, labels[0]))
        products.draw(overlaid_figures(replays), ["png"])
    return Comparison(labels, changes, _metrics(replays), gait_pairs(replays), replays, products)


def _labels(first: Path, second: Path) -> tuple[str, str]:
    """The names of the two; their paths if the names are equal."""
    names = (
        first.stem if first.suffix == ".yaml" else first.name,
        second.stem if second.suffix == ".yaml" else second.name,
    )
    return names if names[0] != names[1] else (str(first), str(second))


def _changes(both: Sequence[Opened]) -> list[Change]:
    models = [opened.model() for opened in both]
    bundles = [opened.bundle([model]) for opened, model in zip(both, models, strict=True)]
    one, other = both
    making = making_changes(one.manifest, other.manifest)
    return ordered([*model_changes(*models), *code_changes(*bundles), *making])


def _folder(second: Opening, other: str) -> Path:
    own = second.path if second.names_result else analysis_folder(second.results) / second.path.stem
    return own / f"comparison-with-{other.replace('/', '_')}"


def _metrics(replays: Sequence[Replay]) -> list[Pair]:
    units = {name: unit for replay in replays for name, unit in replay.model.metrics.items()}
    rows = [replay.outcome.metrics for replay in replays]
    found = [_pair(name, units[name], rows) for name in dict.fromkeys(name for row in rows for name in row)]
    scores = [{} if r.outcome.score is None else {"score": r.outcome.score} for r in replays]
    return [*found, *([_pair("score", "1", scores)] if any(scores) else [])]


def gait_pairs(replays: Sequence[Replay]) -> list[Pair]:
    """Means over the strides of both legs; none unless both models walk."""
    from gaitsim.analysis.gait.changes import gait_changes

    rows = gait_changes(replays)
    means = [
        {n: math.nan if (v := row["values"].get(r.label)) is None else v for n, row in rows.items()} for r in replays
    ]
    return [_pair(name, str(row["unit"]), means) for name, row in rows.items()]


def _pair(name: str, unit: str, rows: Sequence[Mapping[str, float]]) -> Pair:
    first, second = (float(row.get(name, math.nan)) for row in rows)
    return Pair(name, unit, first, second)
