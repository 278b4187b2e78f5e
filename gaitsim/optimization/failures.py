"""Failed candidates, counted by the kind of failure, with one example of each kind."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from gaitsim.optimization.evaluation import Evaluation

# Two failures are of one kind if their reasons differ in numbers only: when, where, how much.
_NUMBER = re.compile(r"-?\b\d+(\.\d+)?(e[-+]?\d+)?\b|\bnan\b|-?\binf\b")


@dataclass
class Failures:
    """The number of failed candidates of each kind, and the first of each."""

    kinds: dict[str, tuple[int, Evaluation]] = field(default_factory=dict)

    def add(self, evaluation: Evaluation) -> None:
        """Count a failed candidate."""
        verdict = evaluation.verdict
        kind = f"{verdict.status}: {_NUMBER.sub('0', verdict.reason)}"
        count, first = self.kinds.get(kind, (0, evaluation))
        self.kinds[kind] = (count + 1, first)

    @property
    def most_common(self) -> list[tuple[int, Evaluation]]:
        """The number and an example of each kind, most frequent first."""
        return sorted(self.kinds.values(), key=lambda found: -found[0])


def reason_of(evaluation: Evaluation) -> str:
    """Why a candidate has no score, in words."""
    verdict = evaluation.verdict
    if verdict.status == "stopped":
        return f"stopped by {verdict.reason}, without a score"
    return verdict.reason or "there was no score"
