"""Errors for users. Each names a place, a value, a rule and the next step."""

from __future__ import annotations

import difflib
import re
import shlex
from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum


def command(*arguments: object) -> str:
    """A gaitsim command that can be pasted into a shell.

    Args:
        arguments: The words after `gaitsim`.

    Returns:
        The command, with quotes where the shell needs them.
    """
    return shlex.join(["gaitsim", *map(str, arguments)])


_LONGEST = 200  # the most letters of a word or value in a message
_LONGEST_LINE = 1000  # the most letters of a line below which a caret is helpful
_LONG = re.compile(r"\S{201,}")


def shortened(text: str) -> str:
    """A text at a length that a message can repeat: the middle of a long text is left out."""
    if len(text) <= _LONGEST:
        return text
    half = _LONGEST // 2
    return f"{text[:half]} ... ({len(text) - 2 * half} letters) ... {text[-half:]}"


class ExitCode(IntEnum):
    """The exit code of the command line, one for each kind of failure."""

    OK = 0
    BUG = 1
    USAGE = 2
    INVALID = 3
    FAILED = 4
    CLUSTER = 5
    INTERRUPTED = 130


@dataclass(frozen=True)
class Mark:
    """A place in a text.

    Attributes:
        file: The name of the file as messages show it.
        line: The line, from 1; 0 if unknown.
        column: The column, from 1.
        text: The text of the line.
    """

    file: str
    line: int = 0
    column: int = 0
    text: str = ""

    def __str__(self) -> str:
        return ":".join([shortened(self.file), *(str(n) for n in (self.line, self.column) if n)])

    @property
    def frame(self) -> str:
        """The line with a caret below the column; empty if the text of the line is unknown."""
        if not self.text or len(self.text) > _LONGEST_LINE:
            return ""
        number = f"{self.line:>5}"
        blank = " " * len(number)
        return f"\n{number} | {self.text}\n{blank} | {' ' * (self.column - 1)}^"


@dataclass(frozen=True)
class Fault:
    """One mistake: its place, the address that it belongs to, and what to do about it."""

    message: str
    mark: Mark | None = None
    address: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "message", _LONG.sub(lambda found: shortened(found[0]), self.message))
        object.__setattr__(self, "address", shortened(self.address))

    def __str__(self) -> str:
        place = [str(self.mark)] if self.mark else []
        address = [self.address] if self.address else []
        return ": ".join([*place, *address, self.message]) + (self.mark.frame if self.mark else "")


class GaitsimError(Exception):
    """An error that the user or the environment causes; never a bug of gaitsim."""

    exit_code = ExitCode.INVALID

    def __init__(self, faults: str | Fault | Iterable[Fault]) -> None:
        if isinstance(faults, str):
            faults = Fault(faults)
        self.faults: tuple[Fault, ...] = (faults,) if isinstance(faults, Fault) else tuple(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))


class InvalidSpec(GaitsimError):
    """The spec breaks a rule."""


class InvalidComponent(GaitsimError):
    """A component file breaks the contract of components."""


class SimulationFailed(GaitsimError):
    """A simulation diverged, or one of its components raised an exception."""

    exit_code = ExitCode.FAILED


class Usage(GaitsimError):
    """The options of a command do not fit together, or do not fit what they name."""

    exit_code = ExitCode.USAGE


class Faults:
    """Collects faults, so that one error reports all mistakes of a stage."""

    def __init__(self) -> None:
        self.found: list[Fault] = []

    def add(self, message: str, mark: Mark | None = None, address: str = "") -> None:
        """Add a fault. A fault with the same text and place as an earlier one is dropped, also for another address."""
        known = (fault for fault in self.found if fault.mark == mark and fault.message == message)
        if not any(fault.address == address or (mark and mark.line) for fault in known):
            self.found.append(Fault(message, mark, address))

    def raise_if_any(self, kind: type[GaitsimError] = InvalidSpec) -> None:
        if self.found:
            raise kind(sorted(self.found, key=_place))


def _place(fault: Fault) -> tuple[str, int, int]:
    mark = fault.mark or Mark("")
    return (mark.file, mark.line, mark.column)


def nearest(word: str, known: Iterable[str]) -> str | None:
    """The known word that is most similar to a misspelt one; None if none is similar."""
    near = difflib.get_close_matches(word[:_LONGEST], sorted(known), n=1, cutoff=0.6)
    return near[0] if near else None


def with_article(noun: str) -> str:
    """The noun with its indefinite article: a muscle, an activation."""
    return f"{'an' if noun[:1] in 'aeiou' else 'a'} {noun}"


def listed(names: Iterable[str], last_word: str) -> str:
    """Words in a row: x, y and z."""
    *others, last = names
    return f" {last_word} ".join([", ".join(others), last] if others else [last])


def alternatives(names: Iterable[str]) -> str:
    """Words as a choice: cma, ga, pso or de."""
    return listed(names, "or")


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """A hint for an unknown word: the most similar known word, or all known words."""
    names = sorted(known)
    near = nearest(word, names)
    if near:
        return f"Did you mean {near}?"
    return f"Known here: {', '.join(names)}." if names else "Nothing is known here."
