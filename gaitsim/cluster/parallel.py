"""Evaluates candidates on Dask workers: sized tasks, lost workers, culprits."""

from __future__ import annotations

import time
import uuid
from collections.abc import Iterator, Sequence
from queue import Empty, Queue
from typing import Any

from gaitsim.cluster.connect import ClusterError
from gaitsim.cluster.fingerprint import differences, fingerprint
from gaitsim.cluster.worker import BundlePlugin, Chunk, Done, evaluate_chunk
from gaitsim.optimization.evaluation import Candidate, Evaluation, Verdict
from gaitsim.results.bundle import Bundle
from gaitsim.simulation.run import Mode

_TASK_SECONDS = 0.2  # a task shorter than this is mostly Dask's own time
_CHUNKS_A_WORKER = 4
_SILENCE = 60.0  # seconds without workers until we give up


Chunked = tuple[Candidate, ...]
Found = tuple[Evaluation, float, str]


class Parallel:
    """An evaluator on the workers of a client."""

    def __init__(self, client: Any, bundle: Bundle, mode: Mode) -> None:
        self._client, self._mode, self._digest = client, mode, bundle.digest
        self._seconds: float | None = None
        self._needs = fingerprint()
        self._check_workers()
        client.register_plugin(BundlePlugin(bundle))

    def close(self) -> None:
        cluster = self._client.cluster
        self._client.close()
        if cluster is not None:
            cluster.close()

    def __call__(self, candidates: Sequence[Candidate]) -> Iterator[Found]:
        finished: Queue[Any] = Queue()
        waiting: dict[Any, Chunked] = {}
        try:
            for chunk in self._chunks(candidates):
                waiting[self._submit(chunk, finished)] = chunk
            while waiting:
                future = self._next(finished)
                found, again = self._collected(future, waiting.pop(future))
                yield from found
                for chunk in again:
                    waiting[self._submit(chunk, finished)] = chunk
        except (OSError, RuntimeError) as error:
            raise self._lost(error) from error

    def _next(self, finished: Queue[Any]) -> Any:
        """The next future; an error if no worker has been there for long."""
        silent_since = None
        while True:
            try:
                return finished.get(timeout=2.0)
            except Empty:
                if self._client.status != "running":
                    raise self._lost(None) from None
                if self._client.nthreads():
                    silent_since = None
                    continue
                silent_since = silent_since or time.monotonic()
                if time.monotonic() - silent_since > _SILENCE:
                    raise ClusterError("all workers are gone; start some, then resume.") from None

    def _collected(self, future: Any, chunk: Chunked) -> tuple[list[Found], list[Chunked]]:
        """Evaluations of a finished task, and what to try again because a worker died of it."""
        if future.status == "finished":
            done: Done = future.result()
            if done.refusal:
                raise ClusterError(f"worker on {done.where}: {done.refusal}")
            self._learn(done)
            return [(evaluation, seconds, done.where) for evaluation, seconds in done.evaluations], []
        error = future.exception() if future.status == "error" else None
        if type(error).__name__ != "KilledWorker":
            raise self._lost(error)
        if len(chunk) > 1:
            return [], [(candidate,) for candidate in chunk]
        reason = "this candidate killed every worker that tried it"
        return [(Evaluation(chunk[0], Verdict("killed", reason, None, {}, 0.0, 0)), 0.0, "")], []

    def _learn(self, done: Done) -> None:
        """A running mean of the seconds of one evaluation."""
        for _, seconds in done.evaluations:
            self._seconds = seconds if self._seconds is None else 0.9 * self._seconds + 0.1 * seconds

    def _chunks(self, candidates: Sequence[Candidate]) -> Iterator[Chunked]:
        workers = max(1, len(self._client.nthreads()))
        by_time = 1 if self._seconds is None else max(1, round(_TASK_SECONDS / max(self._seconds, 1e-6)))
        size = max(1, min(by_time, len(candidates) // (_CHUNKS_A_WORKER * workers)))
        for begin in range(0, len(candidates), size):
            yield tuple(candidates[begin : begin + size])

    def _submit(self, candidates: Chunked, finished: Queue[Any]) -> Any:
        chunk = Chunk(self._digest, self._mode, self._needs, candidates)
        future = self._client.submit(evaluate_chunk, chunk, key=f"gaitsim-{uuid.uuid4()}", pure=False)
        future.add_done_callback(finished.put)
        return future

    def _check_workers(self) -> None:
        """Every worker present must have our versions; the function travels by value."""
        import cloudpickle

        from gaitsim.cluster import handshake

        cloudpickle.register_pickle_by_value(handshake)
        try:
            found = self._client.run(handshake.installed)
        finally:
            cloudpickle.unregister_pickle_by_value(handshake)
        for worker, theirs in found.items():
            wrong = differences(self._needs, theirs)
            if wrong:
                rule = f"it has {wrong}"
                raise ClusterError(f"worker {worker}: {rule}; give all workers this environment and start them again.")

    def _lost(self, error: BaseException | None) -> ClusterError:
        said = f" ({error})" if error is not None and str(error) else ""
        return ClusterError(f"the connection to the scheduler is lost{said}; what has arrived is saved.")
