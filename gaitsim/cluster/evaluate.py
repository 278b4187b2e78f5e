"""Evaluation of a bundle's candidates in this process. Workers of a cluster do the same."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from gaitsim.cluster.cohort import Rows, bundle_rows
from gaitsim.cluster.episodes import Episodes, bundle_episodes
from gaitsim.components.find import display_path
from gaitsim.optimization.evaluation import Candidate, Evaluation, Verdict
from gaitsim.results.bundle import COHORT, Bundle
from gaitsim.simulation.run import Mode


@dataclass(frozen=True)
class EpisodeRunner:
    """The episodes of a candidate or the rows of a cohort, and the folder of their spec and components."""

    episodes: Episodes | Rows
    folder: Path

    def verdict(self, x: Sequence[float]) -> Verdict:
        """Evaluate a candidate. Reasons of failures name files relative to the bundle."""
        found = self.episodes.verdict(x)
        reason = found.reason
        for folder in {str(self.folder), display_path(self.folder)} - {"."}:
            reason = reason.replace(f"{folder}/", "")
        return replace(found, reason=reason)


# A worker keeps what it compiled: one runner for each bundle and mode.
_runners: dict[tuple[str, str], EpisodeRunner] = {}


def runner_of(bundle: Bundle, mode: Mode) -> EpisodeRunner:
    """The runner of a bundle, made from the texts of the bundle only. It is kept for the next call.

    Raises:
        InvalidSpec: The spec breaks a rule.
        InvalidComponent: A component file breaks the contract.
    """
    key = (bundle.digest, mode)
    if key not in _runners:
        made = bundle_rows(bundle, mode) if COHORT in bundle.files else bundle_episodes(bundle, mode)
        _runners[key] = EpisodeRunner(made, bundle.folder)
    return _runners[key]


def forget(bundle: Bundle, mode: Mode) -> None:
    """Drop the runner of a bundle, because a thread that did not return still uses it."""
    _runners.pop((bundle.digest, mode), None)


class Serial:
    """Evaluates candidates one after the other in this process."""

    def __init__(self, runner: EpisodeRunner) -> None:
        self._runner = runner

    def __call__(self, candidates: Sequence[Candidate]) -> Iterator[tuple[Evaluation, float, str]]:
        for candidate in candidates:
            began = time.perf_counter()
            found = self._runner.verdict(candidate.x)
            yield Evaluation(candidate, found), time.perf_counter() - began, socket.gethostname()

    def close(self) -> None:
        """Do nothing: there is nothing to close."""
