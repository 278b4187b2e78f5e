"""The only module that prints: data to stdout, messages to stderr."""

from __future__ import annotations

import json
import math
import shutil
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from threading import Event, Thread
from typing import Any

from gaitsim.cli.table import rows_of
from gaitsim.errors import ExitCode, GaitsimError

PLAIN_EVERY = 5.0  # seconds between lines of progress where stderr is not a terminal


def say(text: str) -> None:
    """Print a message to stderr."""
    print(text, file=sys.stderr)


def rewrite(text: str) -> None:
    """Replace the last line on a terminal."""
    print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)


def progress(what: str, quiet: bool = False) -> Callable[[int, int], None]:
    """Make a function that shows progress in one line.

    On a terminal the line is rewritten. Elsewhere a new line is printed every few seconds.

    Args:
        what: The name of the task.
        quiet: Whether to print nothing if stderr is not a terminal.

    Returns:
        A function of the number of steps that are done, and the number of all steps.
    """
    terminal, reported = sys.stderr.isatty(), time.monotonic()

    def report(done: int, count: int) -> None:
        nonlocal reported
        if terminal:
            rewrite("" if done == count else f"{what}: {done} of {count}")
        elif not quiet and done < count and time.monotonic() - reported >= PLAIN_EVERY:
            reported = time.monotonic()
            say(f"{what}: {done} of {count}")

    return report


@contextmanager
def waiting(what: str, quiet: bool = False) -> Iterator[None]:
    """Print the elapsed time every few seconds during a block without progress of its own, such as one long run.

    Args:
        what: The name of the task.
        quiet: Whether to print nothing if stderr is not a terminal.
    """
    over, began = Event(), time.monotonic()

    def report() -> None:
        while not over.wait(PLAIN_EVERY):
            text = f"{what}: {time.monotonic() - began:.0f} s so far"
            if sys.stderr.isatty():
                rewrite(text)
            elif not quiet:
                say(text)

    thread = Thread(target=report, daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()
        if sys.stderr.isatty() and time.monotonic() - began >= PLAIN_EVERY:
            rewrite("")


@dataclass(frozen=True)
class ConsoleListener:
    """The listener of a study that prints to stderr.

    Attributes:
        quiet: Whether to print no progress if stderr is not a terminal.
    """

    quiet: bool = False

    def say(self, text: str) -> None:
        """Print a message."""
        say(text)

    def say_error(self, error: GaitsimError) -> None:
        """Print every fault of an error."""
        say_error(error)

    def progress(self, what: str) -> Callable[[int, int], None]:
        """Show progress in one line."""
        return progress(what, self.quiet)

    def waiting(self, what: str) -> AbstractContextManager[None]:
        """Print the elapsed time every few seconds."""
        return waiting(what, self.quiet)


def give(text: str) -> None:
    """Print data to stdout."""
    print(text)


def give_json(data: Any) -> None:
    """Print one JSON document to stdout. Numbers that are not finite become null."""
    print(json.dumps(_finite(data), indent=2, ensure_ascii=False))


def give_table(columns: Sequence[str], rows: Iterable[Sequence[str]], title: str = "") -> None:
    """Print a table to stdout. It has its full width if stdout is not a terminal."""
    terminal = sys.stdout.isatty()
    heading, *others = rows_of(columns, [*rows], shutil.get_terminal_size().columns if terminal else None)
    if title:
        print(f" {title}")
    print(*(f"\x1b[1m{line}\x1b[0m" if terminal else line for line in heading), sep="\n")
    for line in (line for row in others for line in row):
        print(line)


def say_error(error: GaitsimError) -> None:
    """Print every fault of an error."""
    for fault in error.faults:
        say(str(fault))


def code_after(error: GaitsimError | None, code: int) -> int:
    """Print the error of saving, if there is one.

    Args:
        error: The error; None if everything was saved.
        code: The exit code without it.

    Returns:
        The exit code of the command.
    """
    if error is None:
        return code
    say_error(error)
    return ExitCode(error.exit_code)


def error_data(error: GaitsimError) -> dict[str, Any]:
    """An error as data, for --json."""
    return {
        "status": error.exit_code.name.lower(),
        "errors": [
            {
                "file": fault.mark.file if fault.mark else None,
                "line": (fault.mark.line or None) if fault.mark else None,
                "column": (fault.mark.column or None) if fault.mark else None,
                "address": fault.address or None,
                "message": fault.message,
            }
            for fault in error.faults
        ],
    }


def formatted(number: float | None) -> str:
    """A number as text for a table."""
    return "-" if number is None or not math.isfinite(number) else f"{number:.5g}"


def _finite(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_finite(value) for value in data]
    if isinstance(data, float) and not math.isfinite(data):
        return None
    return data
