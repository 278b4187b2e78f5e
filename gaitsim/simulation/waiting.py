"""Waits for native code in a way that can be interrupted: by Ctrl-C, or after a time."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

Result = TypeVar("Result")


def in_thread(call: Callable[[], Result], limit: float | None = None) -> Result:
    """What a call returns, made in a thread of its own.

    Errors: TimeoutError after `limit` seconds. The thread then goes on, and what it works on is its own.
    """
    answer: Future[Result] = Future()

    def work() -> None:
        try:
            answer.set_result(call())
        except BaseException as error:
            answer.set_exception(error)

    threading.Thread(target=work, daemon=True).start()
    return answer.result(limit)


def interruptible(call: Callable[[], Result]) -> Result:
    """What a call of native code returns; Ctrl-C ends the wait for it.

    Python hears of Ctrl-C in its main thread only, and only while that runs no native code.
    """
    if threading.current_thread() is not threading.main_thread():
        return call()
    return in_thread(call)
