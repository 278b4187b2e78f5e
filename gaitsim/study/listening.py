"""What hears of a study while it goes on: the command line, or the log of a notebook."""

from __future__ import annotations

import logging
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from gaitsim.errors import GaitsimError


class Listener(Protocol):
    """Hears notices, errors that end nothing, and how far something has come."""

    def say(self, text: str) -> None:
        """A notice, or a warning."""

    def say_error(self, error: GaitsimError) -> None:
        """What could not be made or kept; the rest goes on."""

    def progress(self, what: str) -> Callable[[int, int], None]:
        """What is told of steps of `what` that are done, and of how many."""

    def waiting(self, what: str) -> AbstractContextManager[None]:
        """A block that takes its time and tells nothing of itself."""


class Logged:
    """A listener for a notebook: warnings and errors are logged as warnings, other notices as information."""

    def say(self, text: str) -> None:
        """Log a notice, or a warning."""
        level = logging.WARNING if text.startswith("warning:") else logging.INFO
        logging.getLogger("gaitsim").log(level, "gaitsim: %s", text)

    def say_error(self, error: GaitsimError) -> None:
        """Log an error."""
        logging.getLogger("gaitsim").warning("gaitsim: %s", error)

    def progress(self, what: str) -> Callable[[int, int], None]:  # noqa: ARG002 (as of a listener)
        """Progress is not logged."""
        return lambda done, count: None

    def waiting(self, what: str) -> AbstractContextManager[None]:  # noqa: ARG002
        """Waiting is not logged."""
        return nullcontext()
