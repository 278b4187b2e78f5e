"""The functions that Dask workers run: chunks of candidates in, verdicts out. Errors are returned instead of raised."""

from __future__ import annotations

import socket
import time
import traceback
import uuid
from dataclasses import dataclass
from functools import partial

from distributed import Worker, WorkerPlugin, get_worker

from gaitsim.cluster.evaluate import forget, runner_of
from gaitsim.cluster.fingerprint import differences, fingerprint
from gaitsim.errors import GaitsimError
from gaitsim.optimization.evaluation import Candidate, Evaluation
from gaitsim.results.bundle import Bundle
from gaitsim.simulation.run import Mode
from gaitsim.simulation.threads import in_thread

_bundles: dict[str, Bundle] = {}


class BundlePlugin(WorkerPlugin):  # type: ignore[misc]
    """Sends a bundle to every worker, also to restarted and late ones."""

    def __init__(self, bundle: Bundle) -> None:
        self.bundle = bundle
        # Each search has a plugin of its own, so that the end of one does not remove the bundle of another.
        self.name = f"gaitsim-{uuid.uuid4()}"

    def setup(self, worker: Worker) -> None:  # noqa: ARG002 (Dask passes it by name)
        _bundles[self.bundle.digest] = self.bundle


@dataclass(frozen=True)
class Chunk:
    """Candidates of one bundle, the fingerprint that the worker must have, and the time limit of each candidate."""

    digest: str
    mode: Mode
    needs: dict[str, str]
    candidates: tuple[Candidate, ...]
    limit: float


@dataclass(frozen=True)
class Done:
    """The answer of a worker: evaluations with their times, whether the next one exceeded its time, or what is
    wrong.
    """

    worker: str
    host: str
    evaluations: tuple[tuple[Evaluation, float], ...] = ()
    too_long: bool = False
    refusal: str = ""
    bug: str = ""


def evaluate_chunk(chunk: Chunk) -> Done:
    """Evaluate the candidates of a chunk one after the other, until one exceeds its time."""
    worker, host = str(get_worker().address), socket.gethostname()
    wrong = differences(chunk.needs, fingerprint())
    if wrong:
        return Done(worker, host, refusal=f"it has {wrong}")
    if chunk.digest not in _bundles:
        return Done(worker, host, refusal="it has not been given the model")
    try:
        found, too_long = _evaluated(chunk)
    except GaitsimError as error:
        return Done(worker, host, refusal=str(error))
    except Exception:
        return Done(worker, host, bug=traceback.format_exc())
    return Done(worker, host, tuple(found), too_long)


def _evaluated(chunk: Chunk) -> tuple[list[tuple[Evaluation, float]], bool]:
    bundle = _bundles[chunk.digest]
    runner = runner_of(bundle, chunk.mode)
    found: list[tuple[Evaluation, float]] = []
    for candidate in chunk.candidates:
        began = time.perf_counter()
        try:
            verdict = in_thread(partial(runner.verdict, candidate.x), chunk.limit)
        except TimeoutError:
            forget(bundle, chunk.mode)
            return found, True
        found.append((Evaluation(candidate, verdict), time.perf_counter() - began))
    return found, False
