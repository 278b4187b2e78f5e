"""Evaluates candidates of a bundle in this process; workers of a cluster do the same."""

from __future__ import annotations

import math
import socket
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from gaitsim.optimization.evaluation import Candidate, Evaluation, Verdict
from gaitsim.results.bundle import Bundle, bundle_model
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Mode, Simulator

# A worker keeps what it compiled: one simulator for each bundle and mode.
_simulators: dict[tuple[str, str], Simulator] = {}


def simulator_of(bundle: Bundle, mode: Mode) -> Simulator:
    """The simulator of a bundle, made from the bundle's own files and nothing else.

    Errors: InvalidSpec, InvalidComponent.
    """
    key = (bundle.digest, mode)
    if key not in _simulators:
        with tempfile.TemporaryDirectory(prefix="gaitsim-") as folder:
            bundle.write(Path(folder))
            _simulators[key] = Simulator(bundle_model(Path(folder), bundle.name), mode)
    return _simulators[key]


def verdict(outcome: Outcome) -> Verdict:
    """What the journal keeps of an outcome."""
    metrics = {n: v if math.isfinite(v) else None for n, v in outcome.metrics.items()}
    return Verdict(
        outcome.status, outcome.reason, outcome.score, metrics, outcome.simulated_seconds, outcome.steps
    )


class Serial:
    """Evaluates one candidate after the other, in this process."""

    def __init__(self, simulator: Simulator) -> None:
        self._simulator = simulator

    def __call__(self, candidates: Sequence[Candidate]) -> Iterator[tuple[Evaluation, float, str]]:
        for candidate in candidates:
            began = time.perf_counter()
            found = verdict(self._simulator.run(candidate.x))
            yield Evaluation(candidate, found), time.perf_counter() - began, socket.gethostname()

    def close(self) -> None:
        """There is nothing to close."""
