"""What runs on a worker: chunks of candidates in, verdicts out; nothing is raised that could be said."""

from __future__ import annotations

import socket
import time
import traceback
from dataclasses import dataclass

from distributed import Worker, WorkerPlugin

from gaitsim.cluster.evaluate import simulator_of, verdict
from gaitsim.cluster.fingerprint import differences, fingerprint
from gaitsim.errors import GaitsimError
from gaitsim.optimization.evaluation import Candidate, Evaluation
from gaitsim.results.bundle import Bundle
from gaitsim.simulation.run import Mode

_bundles: dict[str, Bundle] = {}


class BundlePlugin(WorkerPlugin):  # type: ignore[misc]
    """Brings a bundle to every worker: those present, restarted ones and late ones."""

    def __init__(self, bundle: Bundle) -> None:
        self.bundle = bundle
        self.name = f"gaitsim-{bundle.digest[:16]}"

    def setup(self, worker: Worker) -> None:
        _bundles[self.bundle.digest] = self.bundle


@dataclass(frozen=True)
class Chunk:
    """Some candidates of one bundle, and what a worker must be to evaluate them."""

    digest: str
    mode: Mode
    needs: dict[str, str]
    candidates: tuple[Candidate, ...]


@dataclass(frozen=True)
class Done:
    """What a worker found: evaluations with their seconds, or why it could not try."""

    evaluations: tuple[tuple[Evaluation, float], ...]
    where: str
    refusal: str = ""


def evaluate_chunk(chunk: Chunk) -> Done:
    """Evaluate the candidates of a chunk, one after the other."""
    where = socket.gethostname()
    wrong = differences(chunk.needs, fingerprint())
    if wrong:
        return Done((), where, f"the worker has {wrong}")
    if chunk.digest not in _bundles:
        return Done((), where, "the worker has not been given the model")
    try:
        simulator = simulator_of(_bundles[chunk.digest], chunk.mode)
        found = []
        for candidate in chunk.candidates:
            began = time.perf_counter()
            outcome = simulator.run(candidate.x)
            found.append((Evaluation(candidate, verdict(outcome)), time.perf_counter() - began))
    except GaitsimError as error:
        return Done((), where, str(error))
    except Exception:
        return Done((), where, traceback.format_exc())
    return Done(tuple(found), where)
