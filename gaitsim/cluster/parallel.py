"""Evaluation on Dask workers, with tasks of suitable length. Candidates that make workers die are found."""

from __future__ import annotations

import contextlib
import time
import uuid
from collections.abc import Iterator, Sequence
from queue import Empty, Queue
from typing import Any

from distributed import KilledWorker

from gaitsim.cluster.fingerprint import differences, fingerprint
from gaitsim.cluster.time_limits import Pace, TimedEvaluation, TimeLimits, killed, too_late
from gaitsim.cluster.unreachable import ClusterError
from gaitsim.cluster.worker import BundlePlugin, Chunk, Done, evaluate_chunk
from gaitsim.optimization.evaluation import Candidate
from gaitsim.results.bundle import Bundle
from gaitsim.simulation.run import Mode

_TASK_SECONDS = 0.1  # s; shorter tasks are mostly overhead of Dask, longer ones keep others waiting
_CHUNKS_A_WORKER = 4
_GATHER_SECONDS = 10.0  # s; a result has some kilobytes, so one that takes longer was on a lost worker
_SAME = "give all workers this environment and start them again"

Chunked = tuple[Candidate, ...]


class _ResultLost(Exception):
    """A worker finished a task and died before its result was fetched."""


class Parallel:
    """An evaluator on the workers of a Dask client."""

    def __init__(self, client: Any, bundle: Bundle, mode: Mode, time_limits: TimeLimits | None = None) -> None:
        self._client, self._mode, self._digest = client, mode, bundle.digest
        self._time_limits = time_limits or TimeLimits()
        self._pace = Pace(self._time_limits)
        self._needs = fingerprint()
        self._plugin = BundlePlugin(bundle)
        try:
            self._check_workers()
            client.register_plugin(self._plugin)
        except BaseException as error:
            self.close()
            if isinstance(error, OSError):
                raise self._lost(error) from error
            raise

    def close(self) -> None:
        """Remove the model from the workers, and end workers that gaitsim started."""
        cluster = self._client.cluster
        if self._client.status == "running":
            with contextlib.suppress(OSError, ValueError):
                self._client.unregister_worker_plugin(self._plugin.name)
        self._client.close()
        if cluster is not None:
            cluster.close()

    def __call__(self, candidates: Sequence[Candidate]) -> Iterator[TimedEvaluation]:
        finished: Queue[Any] = Queue()
        return self._in_turn({self._submit(chunk, finished): chunk for chunk in self._chunks(candidates)}, finished)

    def _in_turn(self, waiting: dict[Any, Chunked], finished: Queue[Any]) -> Iterator[TimedEvaluation]:
        suspects: list[Candidate] = []
        yield from self._found(waiting, finished, suspects)
        for candidate in suspects:
            # Alone, so that the death of a worker is caused by this candidate and not by another one.
            again: list[Candidate] = []
            yield from self._found({self._submit((candidate,), finished): (candidate,)}, finished, again)
            if again:
                yield killed(candidate)

    def _found(
        self, waiting: dict[Any, Chunked], finished: Queue[Any], suspects: list[Candidate]
    ) -> Iterator[TimedEvaluation]:
        """The results of submitted chunks. Candidates whose workers died are added to the suspects."""
        slow: set[Candidate] = set()
        while waiting:
            future = self._next(finished)
            chunk = waiting.pop(future)
            try:
                done = self._done(future)
            except _ResultLost:
                waiting[self._submit(chunk, finished)] = chunk
                continue
            if done is None:
                suspects += chunk
                continue
            for _, seconds in done.evaluations:
                self._pace.learn(seconds)
            yield from ((evaluation, seconds, done.host) for evaluation, seconds in done.evaluations)
            if not done.too_long:
                continue
            self._restart(done.worker)
            late, rest = chunk[len(done.evaluations)], chunk[len(done.evaluations) + 1 :]
            if late in slow:
                yield too_late(late)
            again = [chunk for chunk in (rest, () if late in slow else (late,)) if chunk]
            slow.add(late)
            waiting |= {self._submit(chunk, finished): chunk for chunk in again}

    def _next(self, finished: Queue[Any]) -> Any:
        """The next future that is done.

        Raises:
            ClusterError: There was no worker for a long time.
        """
        silent_since = None
        while True:
            with contextlib.suppress(Empty):
                return finished.get(timeout=1.0)
            if self._workers():
                silent_since = None
                continue
            silent_since = silent_since or time.monotonic()
            if time.monotonic() - silent_since > self._time_limits.workers:
                place = self._client.scheduler.address
                raise ClusterError(f"{place}: all workers are gone; start some: dask worker {place}.")

    def _workers(self) -> int:
        if self._client.status != "running":
            raise self._lost(None)
        try:
            return len(self._client.nthreads())
        except (OSError, RuntimeError) as error:
            raise self._lost(error) from error

    def _done(self, future: Any) -> Done | None:
        """The result of a finished task; None if its workers died.

        Raises:
            _ResultLost: The worker died before its result was fetched.
            ClusterError: The worker refused the task.
            RuntimeError: gaitsim has a bug.
        """
        if future.status == "lost":
            raise _ResultLost
        if future.status == "finished":
            done = _gathered(future)
            if done.refusal:
                raise ClusterError(f"worker {done.worker}: {done.refusal}; {_SAME}.")
            if done.bug:
                raise RuntimeError(f"on worker {done.worker}:\n{done.bug}")
            return done
        error = future.exception() if future.status == "error" else None
        if isinstance(error, KilledWorker):
            return None
        if error is not None and self._client.status == "running":
            raise ClusterError(f"a worker cannot do its task ({type(error).__name__}: {error}); {_SAME}.")
        raise self._lost(error)

    def _restart(self, worker: str) -> None:
        """End a worker with a thread that does not return. A worker without a nanny continues with that thread."""
        with contextlib.suppress(OSError, ValueError, TimeoutError):
            self._client.restart_workers([worker], raise_for_error=False)

    def _chunks(self, candidates: Sequence[Candidate]) -> Iterator[Chunked]:
        if not candidates:
            return
        share = len(candidates) // (_CHUNKS_A_WORKER * max(1, self._workers()))
        size = max(1, min(self._pace.fitting(_TASK_SECONDS), share))
        for begin in range(0, len(candidates), size):
            yield tuple(candidates[begin : begin + size])

    def _submit(self, candidates: Chunked, finished: Queue[Any]) -> Any:
        chunk = Chunk(self._digest, self._mode, self._needs, candidates, self._pace.limit)
        try:
            future = self._client.submit(evaluate_chunk, chunk, key=f"gaitsim-{uuid.uuid4()}", pure=False)
        except (OSError, RuntimeError) as error:
            raise self._lost(error) from error
        future.add_done_callback(finished.put)
        return future

    def _check_workers(self) -> None:
        """Check that every worker has our versions. The function that asks is sent by value."""
        import cloudpickle

        from gaitsim.cluster import handshake

        cloudpickle.register_pickle_by_value(handshake)
        try:
            found = self._client.run(handshake.installed, on_error="return")
        finally:
            cloudpickle.unregister_pickle_by_value(handshake)
        for worker, theirs in found.items():
            if isinstance(theirs, BaseException):
                raise ClusterError(f"worker {worker}: it cannot say what it has ({theirs}); {_SAME}.")
            wrong = differences(self._needs, theirs)
            if wrong:
                raise ClusterError(f"worker {worker}: it has {wrong}; {_SAME}.")

    def _lost(self, error: BaseException | None) -> ClusterError:
        why = f" ({error})" if error is not None and str(error) else ""
        place = self._client.scheduler.address if self._client.scheduler else "the scheduler"
        return ClusterError(f"{place}: the connection to the scheduler is lost{why}; start it and its workers again.")


def _gathered(future: Any) -> Done:
    """Fetch the result of a finished task.

    Raises:
        _ResultLost: The worker died before.
    """
    try:
        done: Done = future.result(timeout=_GATHER_SECONDS)
    except (TimeoutError, KilledWorker) as error:
        raise _ResultLost from error
    return done
