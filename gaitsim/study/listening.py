"""What hears of a study while it goes on; in a notebook no one does."""

from __future__ import annotations

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


class Silence:
    """A listener for a notebook: what is said stands in the values that come back."""

    def say(self, text: str) -> None:
        """Nothing."""

    def say_error(self, error: GaitsimError) -> None:
        """Nothing."""

    def progress(self, what: str) -> Callable[[int, int], None]:  # noqa: ARG002 (as of a listener)
        """Told in vain."""
        return lambda done, count: None

    def waiting(self, what: str) -> AbstractContextManager[None]:  # noqa: ARG002
        """Nothing is said."""
        return nullcontext()
