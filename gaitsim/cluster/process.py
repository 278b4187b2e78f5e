"""A worker process of this machine: candidates arrive through a pipe, verdicts leave through another."""

from __future__ import annotations

import os
import signal
import threading
import time
import traceback
from collections import deque
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any

from gaitsim.cluster.evaluate import runner_of
from gaitsim.cluster.unreachable import ClusterError
from gaitsim.optimization.evaluation import Candidate, Verdict
from gaitsim.results.bundle import Bundle
from gaitsim.simulation.run import Mode

# A copy of a process that has the model in native code is there in milliseconds. Where copies are not
# safe (macOS: its own libraries have threads), workers begin anew and load the model themselves.
START_METHOD = "fork" if os.uname().sysname == "Linux" else "spawn"

_DRIVERS = {signal.SIGINT, signal.SIGTERM}

Answer = tuple[Verdict | str, float]  # a verdict, or the traceback of a bug; and the seconds that it took


class Lifeline:
    """A pipe that is open while the driver lives. Its readers notice the end of the driver, whatever its cause."""

    def __init__(self, method: str) -> None:
        self.held, self.kept = get_context(method).Pipe(duplex=False)

    def close(self) -> None:
        self.held.close()
        self.kept.close()


@dataclass
class Worker:
    """A process, and the candidates that it was given and has not answered."""

    process: Any
    tasks: Connection
    answers: Connection
    given: deque[Candidate] = field(default_factory=deque)
    since: float = 0.0  # the start of the first of them

    def give(self, candidates: Sequence[Candidate]) -> None:
        """Send candidates. A dead worker is noticed when its answer is awaited."""
        if not self.given:
            self.since = time.monotonic()
        self.given += candidates
        with suppress(BrokenPipeError):
            self.tasks.send(candidates)

    def answer(self) -> tuple[Candidate, Answer]:
        """Wait for the next answer.

        Raises:
            EOFError: The worker died.
            OSError: The worker died.
        """
        answer: Answer = self.answers.recv()
        self.since = time.monotonic()
        return self.given.popleft(), answer

    def end(self) -> None:
        """End the process at once."""
        self.process.kill()
        self.process.join()
        self.process.close()
        self.tasks.close()
        self.answers.close()


def started(bundle: Bundle, mode: Mode, lifeline: Lifeline, method: str) -> Worker:
    """Start a worker.

    Raises:
        ClusterError: No process can be started.
    """
    context: Any = get_context(method)
    tasks_out, tasks = context.Pipe(duplex=False)
    answers, answers_in = context.Pipe(duplex=False)
    arguments = (bundle, mode, tasks_out, answers_in, lifeline.held, lifeline.kept)
    process = context.Process(target=_serve, args=arguments, daemon=True, name="gaitsim worker")
    # Signals that the driver handles are blocked until the worker ignores them.
    signal.pthread_sigmask(signal.SIG_BLOCK, _DRIVERS)
    try:
        process.start()
    except OSError as error:
        reason = error.strerror or str(error)
        raise ClusterError(f"a worker cannot be started on this machine ({reason}); use fewer --workers.") from error
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _DRIVERS)
    # Held by the worker alone, so that the pipe of answers closes when it dies.
    tasks_out.close()
    answers_in.close()
    return Worker(process, tasks, answers)


def _serve(
    bundle: Bundle, mode: Mode, tasks: Connection, answers: Connection, held: Connection, kept: Connection
) -> None:
    """The main loop of a worker process."""
    kept.close()  # otherwise the lifeline of the other workers would never close
    threading.Thread(target=_end_with_driver, args=(held,), daemon=True).start()
    # Ctrl-C reaches every process of a terminal. The driver handles it and ends its workers.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _DRIVERS)
    with suppress(EOFError, OSError):
        while True:
            for candidate in tasks.recv():
                began = time.perf_counter()
                verdict = _verdict(bundle, mode, candidate)
                answers.send((verdict, time.perf_counter() - began))


def _verdict(bundle: Bundle, mode: Mode, candidate: Candidate) -> Verdict | str:
    try:
        return runner_of(bundle, mode).verdict(candidate.x)
    except Exception:
        return traceback.format_exc()


def _end_with_driver(held: Connection) -> None:
    with suppress(EOFError, OSError):
        held.recv_bytes()
    os._exit(0)
