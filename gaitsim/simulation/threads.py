"""Threads for native code, and waiting for them in a way that Ctrl-C or a time limit can end."""

from __future__ import annotations

import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import suppress
from queue import SimpleQueue
from typing import Any, TypeVar

Result = TypeVar("Result")


def cores() -> int:
    """The number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def in_thread(call: Callable[[], Result], limit: float | None = None) -> Result:
    """Make a call in a thread of its own.

    After a timeout the thread continues, so it must own what it works on.

    Args:
        call: The call.
        limit: The time limit in s; None for none.

    Returns:
        What the call returns.

    Raises:
        TimeoutError: The limit is exceeded.
    """
    answer: Future[Result] = Future()
    threading.Thread(target=_answer, args=(call, answer), daemon=True).start()
    return answer.result(limit)


def in_threads(calls: Sequence[Callable[[], Result]], count: int) -> Iterator[Result]:
    """Make calls in a few threads.

    Args:
        calls: The calls.
        count: The number of threads.

    Yields:
        What the calls return, in their order. Ending early does not wait for the threads.
    """
    answers = [Future[Result]() for _ in calls]
    left = deque(zip(calls, answers, strict=True))

    def work() -> None:
        while left:
            with suppress(IndexError):  # another thread was faster
                _answer(*left.popleft())

    for _ in range(min(count, len(calls))):
        threading.Thread(target=work, daemon=True).start()
    try:
        for answer in answers:
            yield answer.result()
    finally:
        left.clear()


def interruptible(call: Callable[[], Result]) -> Result:
    """Make a call of native code that Ctrl-C can interrupt.

    Python handles Ctrl-C in the main thread only, and not while that runs native code.
    """
    main = threading.current_thread() is threading.main_thread()
    if not main or signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        return call()
    # Waiting threads are kept for the next call; an abandoned one does not return.
    calls = _idle.pop() if _idle else _new_thread()
    answer: Future[Result] = Future()
    calls.put((call, answer))
    found = answer.result()
    _idle.append(calls)
    return found


_idle: list[SimpleQueue[tuple[Callable[[], Any], Future[Any]]]] = []


def _new_thread() -> SimpleQueue[tuple[Callable[[], Any], Future[Any]]]:
    """A queue of calls that a new thread makes one after the other."""
    calls: SimpleQueue[tuple[Callable[[], Any], Future[Any]]] = SimpleQueue()

    def work() -> None:
        while True:
            _answer(*calls.get())

    threading.Thread(target=work, daemon=True).start()
    return calls


def _answer(call: Callable[[], Result], answer: Future[Result]) -> None:
    try:
        answer.set_result(call())
    except BaseException as error:
        answer.set_exception(error)
