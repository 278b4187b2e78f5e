"""Two results or specs beside each other: in what their models differ, then their runs, in numbers and figures."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

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
    """A number that both runs may have; nan for none.

    Attributes:
        unit: Of both.
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
        """The difference in % of the first; nan where that is 0."""
        return 100 * self.difference / abs(self.first) if self.first else math.nan


@dataclass(frozen=True)
class Comparison:
    """How two runs differ.

    Attributes:
        labels: What they are called.
        changes: Of their models.
        metrics: What their measures say, and their costs.
        gait: Means over strides, of two walkers.
        replays: The runs.
        products: Figures, with what could not be made.
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
    """Compare two results or specs; each is run once more.

    Args:
        first, second: What is compared.
        listener: Hears what a reader should know of the runs.
        figures: Whether the runs are drawn over one another.
        folder: Where the figures go; None for a folder in the second result, or below analysis/ of a spec.

    Raises:
        BadResult, Untrusted, InvalidSpec, InvalidComponent, Usage, CannotSave.
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
    """Names of the two; their paths if the names are one."""
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
    own = second.path if second.names_result else Path("analysis") / second.path.stem
    return own / f"comparison-with-{other.replace('/', '_')}"


def _metrics(replays: Sequence[Replay]) -> list[Pair]:
    units = {name: unit for replay in replays for name, unit in replay.model.metrics.items()}
    rows = [replay.outcome.metrics for replay in replays]
    found = [_pair(name, units[name], rows) for name in dict.fromkeys(name for row in rows for name in row)]
    scores = [{} if r.outcome.score is None else {"score": r.outcome.score} for r in replays]
    return [*found, *([_pair("score", "1", scores)] if any(scores) else [])]


def gait_pairs(replays: Sequence[Replay]) -> list[Pair]:
    """Means over the strides of both legs; nothing unless both walk."""
    from gaitsim.analysis.gait.changes import gait_changes

    rows = gait_changes(replays)
    means = [
        {n: math.nan if (v := row["values"].get(r.label)) is None else v for n, row in rows.items()} for r in replays
    ]
    return [_pair(name, str(row["unit"]), means) for name, row in rows.items()]


def _pair(name: str, unit: str, rows: Sequence[Mapping[str, float]]) -> Pair:
    first, second = (float(row.get(name, math.nan)) for row in rows)
    return Pair(name, unit, first, second)
