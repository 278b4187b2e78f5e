"""Evaluation in processes of this machine, over pipes that no other process can open."""

from __future__ import annotations

import gc
import socket
import time
from collections import Counter, deque
from collections.abc import Iterator, Sequence
from multiprocessing.connection import wait

from gaitsim.cluster.evaluate import runner_of
from gaitsim.cluster.process import START_METHOD, Lifeline, Worker, started
from gaitsim.cluster.time_limits import Pace, TimedEvaluation, TimeLimits, killed, too_late
from gaitsim.optimization.evaluation import Candidate, Evaluation
from gaitsim.results.bundle import Bundle
from gaitsim.simulation.run import Mode

_AHEAD = 0.002  # seconds of work that wait for a busy worker, so that it need not wait for the driver
_MOST_AHEAD = 4  # this number of candidates fits into a pipe, whatever their size
_TRIES = 3  # deaths after which the candidate is the cause; a single one may come from outside


class Local:
    """An evaluator with several worker processes.

    Args:
        bundle: What is evaluated.
        mode: Native code ("rapid") or plain Python ("normal").
        workers: The number of processes.
        time_limits: Of candidates.
        method: How processes start; see `multiprocessing`.
    """

    def __init__(
        self,
        bundle: Bundle,
        mode: Mode,
        workers: int,
        time_limits: TimeLimits | None = None,
        method: str = START_METHOD,
    ) -> None:
        self._bundle, self._mode, self._method = bundle, mode, method
        self._pace = Pace(time_limits or TimeLimits())
        self._host = socket.gethostname()
        if method == "fork":
            runner_of(bundle, mode)  # copied with this process
            gc.freeze()  # a garbage collection in a copy would touch, and thereby copy, every page
        self._lifeline = Lifeline(method)
        self._workers: list[Worker] = []
        try:
            for _ in range(workers):
                self._workers.append(self._started())
        except BaseException:
            self.close()
            raise

    def __call__(self, candidates: Sequence[Candidate]) -> Iterator[TimedEvaluation]:
        left = deque(candidates)
        self._give(left)
        return self._found(left)

    def close(self) -> None:
        """End the workers at once."""
        for worker in self._workers:
            worker.end()
        self._workers.clear()
        self._lifeline.close()

    def _started(self) -> Worker:
        return started(self._bundle, self._mode, self._lifeline, self._method)

    def _found(self, left: deque[Candidate]) -> Iterator[TimedEvaluation]:
        deaths: Counter[Candidate] = Counter()
        late: set[Candidate] = set()
        while any(worker.given for worker in self._workers):
            ready = self._ready()
            for worker in ready:
                try:
                    candidate, (verdict, seconds) = worker.answer()
                except (EOFError, OSError):
                    culprit = self._replaced(worker, left)
                    deaths[culprit] += 1
                    if deaths[culprit] < _TRIES:
                        left.append(culprit)
                    else:
                        yield killed(culprit)
                    continue
                if isinstance(verdict, str):
                    raise RuntimeError(f"in a worker:\n{verdict}")
                self._pace.learn(seconds)
                self._give(left)
                yield Evaluation(candidate, verdict), seconds, self._host
            for worker in [] if ready else self._overdue():
                culprit = self._replaced(worker, left)
                if culprit in late:
                    yield too_late(culprit)
                else:
                    late.add(culprit)
                    left.append(culprit)
            self._give(left)

    def _give(self, left: deque[Candidate]) -> None:
        """Hand out candidates in their order: one to each worker, and a few more while evaluations are short."""
        ahead = min(1 + self._pace.fitting(_AHEAD), _MOST_AHEAD, 1 + len(left) // len(self._workers)) if left else 0
        for worker in self._workers:
            size = min(ahead - len(worker.given), len(left))
            if size > 0:
                worker.give([left.popleft() for _ in range(size)])

    def _ready(self) -> list[Worker]:
        """The workers that have an answer or are dead; none if a worker exceeds its time."""
        busy = {worker.answers: worker for worker in self._workers if worker.given}
        seconds_left = min(worker.since for worker in busy.values()) + self._pace.limit - time.monotonic()
        return [busy[connection] for connection in wait([*busy], max(0.0, seconds_left))]  # type: ignore[index]

    def _overdue(self) -> list[Worker]:
        now = time.monotonic()
        return [worker for worker in self._workers if worker.given and now - worker.since >= self._pace.limit]

    def _replaced(self, worker: Worker, left: deque[Candidate]) -> Candidate:
        """End a worker and start another one.

        Returns:
            The candidate that the worker was evaluating. Its other candidates are put back.
        """
        culprit, *others = worker.given
        left.extendleft(reversed(others))
        worker.end()
        self._workers[self._workers.index(worker)] = self._started()
        return culprit
