"""Listeners, which receive messages while a study runs: the command line, or the log of a notebook."""

from __future__ import annotations

import logging
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from gaitsim.errors import GaitsimError


class Listener(Protocol):
    """Receives notices, errors that stop nothing, and progress."""

    def say(self, text: str) -> None:
        """Receive a notice or a warning."""

    def say_error(self, error: GaitsimError) -> None:
        """Receive an error of something that was left out."""

    def progress(self, what: str) -> Callable[[int, int], None]:
        """A function that receives how many steps of `what` are done, and of how many."""

    def waiting(self, what: str) -> AbstractContextManager[None]:
        """A block that takes long and reports no progress."""


class LogListener:
    """A listener for notebooks: warnings and errors are logged as warnings, other notices as information."""

    def say(self, text: str) -> None:
        """Log a notice, or a warning."""
        level = logging.WARNING if text.startswith("warning:") else logging.INFO
        logging.getLogger("gaitsim").log(level, "gaitsim: %s", text)

    def say_error(self, error: GaitsimError) -> None:
        """Log an error."""
        logging.getLogger("gaitsim").warning("gaitsim: %s", error)

    def progress(self, what: str) -> Callable[[int, int], None]:  # noqa: ARG002 (as of a listener)
        """A function that ignores progress."""
        return lambda done, count: None

    def waiting(self, what: str) -> AbstractContextManager[None]:  # noqa: ARG002
        """A block without messages."""
        return nullcontext()
