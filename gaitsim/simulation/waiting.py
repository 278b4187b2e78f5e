"""Threads for native code, and waiting for it in a way that can be interrupted: by Ctrl-C, or after a time."""

from __future__ import annotations

import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from contextlib import suppress
from typing import TypeVar

Result = TypeVar("Result")


def cores() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def in_thread(call: Callable[[], Result], limit: float | None = None) -> Result:
    """What a call returns, made in a thread of its own.

    Errors: TimeoutError after `limit` seconds. The thread then goes on, and what it works on is its own.
    """
    answer: Future[Result] = Future()
    threading.Thread(target=_answer, args=(call, answer), daemon=True).start()
    return answer.result(limit)


def in_threads(calls: Sequence[Callable[[], Result]], count: int) -> Iterator[Result]:
    """What calls return, in their order; they are made in some threads, which nothing waits for that ends early."""
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
    """What a call of native code returns; Ctrl-C ends the wait for it.

    Python hears of Ctrl-C in its main thread only, and only while that runs no native code.
    """
    main = threading.current_thread() is threading.main_thread()
    if not main or signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        return call()
    return in_thread(call)


def _answer(call: Callable[[], Result], answer: Future[Result]) -> None:
    try:
        answer.set_result(call())
    except BaseException as error:
        answer.set_exception(error)
