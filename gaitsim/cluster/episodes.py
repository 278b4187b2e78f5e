"""Several episodes for each candidate, such as other seeds, pushes or slopes: a model for each, and one score."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from gaitsim.components.find import Library
from gaitsim.errors import Faults
from gaitsim.model import Free, Model
from gaitsim.optimization.combination import combined
from gaitsim.optimization.evaluation import Verdict
from gaitsim.results.bundle import Bundle
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.resolve import resolve
from gaitsim.spec.schema import optimize_section
from gaitsim.spec.study import episodes
from gaitsim.text.document import MappingNode


@dataclass(frozen=True)
class Episodes:
    """The simulators of a candidate's episodes, and the way to combine their scores."""

    simulators: tuple[Simulator, ...]
    combine: str = "mean"

    def verdict(self, x: Sequence[float]) -> Verdict:
        """Simulate all episodes of a candidate.

        Args:
            x: The values of the tuned numbers, in SI.

        Returns:
            The metrics of the first episode, and the score of each.
        """
        outcomes = [simulator.run(x) for simulator in self.simulators]
        first = outcomes[0]
        metrics = {n: v if math.isfinite(v) else None for n, v in first.metrics.items()}
        if len(outcomes) == 1:
            seconds = first.simulated_seconds
            return Verdict(first.status, first.reason, first.score, metrics, seconds, first.steps)
        status, reason = _ended(outcomes)
        return Verdict(
            status,
            reason,
            combined([outcome.score for outcome in outcomes], self.combine),
            metrics,
            math.fsum(outcome.simulated_seconds for outcome in outcomes),
            sum(outcome.steps for outcome in outcomes),
            tuple({"status": o.status, "score": o.score, "steps": o.steps} for o in outcomes),
        )


def _ended(outcomes: Sequence[Outcome]) -> tuple[str, str]:
    """Status and reason of a candidate: those of the first episode that failed, else of the first that was stopped."""
    for status in ("failed", "stopped"):
        for i, outcome in enumerate(outcomes, start=1):
            if outcome.status == status:
                return status, f"episode {i}: {outcome.reason}"
    return outcomes[0].status, ""


def bundle_episodes(bundle: Bundle, mode: Mode) -> Episodes:
    """The episodes of a bundle.

    Raises:
        InvalidSpec: The spec breaks a rule.
        InvalidComponent: A component file breaks the contract.
        BadResult: The tuned values of the bundle cannot be read.
    """
    document, starts = bundle.document(), bundle.starts()
    library, name = bundle.library(), bundle.name
    models = episode_models(document, library, name) or [resolve(document, library, name)]
    simulators = tuple(Simulator(model.started_at(starts), mode) for model in models)
    return Episodes(simulators, optimize_section(document).combine)


def episode_models(document: MappingNode, library: Library, name: str) -> list[Model]:
    """The model of each episode; none if the spec has no episodes.

    Raises:
        InvalidSpec: The spec breaks a rule, or an episode changes what is tuned.
    """
    rows = episodes(document)
    if not rows[0].settings and len(rows) == 1:
        return []
    models = [resolve(row.document, library, name) for row in rows]
    faults, tuned = Faults(), resolve(document, library, name).free
    for i, (row, model) in enumerate(zip(rows, models, strict=True)):
        change = _change(tuned, model.free)
        if change:
            rule = f"this episode {change}; an episode sets numbers that no search changes."
            faults.add(rule, row.mark, f"optimize.episodes.{i}")
    faults.raise_if_any()
    return models


def _change(before: Sequence[Free], after: Sequence[Free]) -> str:
    """The difference in what is tuned, in words; empty if there is none."""
    old, new = ({f.address: (f.low, f.high, f.start, f.spread) for f in free} for free in (before, after))
    lost, more = [a for a in old if a not in new], [a for a in new if a not in old]
    if lost:
        return f"takes {', '.join(lost)} from what is tuned"
    if more:
        return f"adds {', '.join(more)} to what is tuned"
    moved = [address for address in old if old[address] != new[address]]
    return f"moves the bounds or the start of {', '.join(moved)}" if moved or [*old] != [*new] else ""
