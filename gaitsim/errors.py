"""What goes wrong, said so that it can be mended: place, value, rule, next move."""

from __future__ import annotations

import difflib
import re
import shlex
from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum


def command(*words: object) -> str:
    """A command of gaitsim as it can be pasted into a shell."""
    return shlex.join(["gaitsim", *map(str, words)])


_LONGEST = 200  # letters of one word or value that a message repeats
_LONGEST_LINE = 1000  # letters of a line of text below which a caret still shows a place
_LONG = re.compile(r"\S{201,}")


def shortened(text: str) -> str:
    """A text as a message can repeat it: without what is in the middle of a long one."""
    if len(text) <= _LONGEST:
        return text
    half = _LONGEST // 2
    return f"{text[:half]} ... ({len(text) - 2 * half} letters) ... {text[-half:]}"


class ExitCode(IntEnum):
    """The kind of a failure, as the shell sees it."""

    OK = 0
    BUG = 1
    USAGE = 2
    INVALID = 3
    FAILED = 4
    CLUSTER = 5
    INTERRUPTED = 130


@dataclass(frozen=True)
class Mark:
    """A place in a text: file, line and column (from 1), and the line itself."""

    file: str
    line: int = 0
    column: int = 0
    text: str = ""

    def __str__(self) -> str:
        return ":".join([shortened(self.file), *(str(n) for n in (self.line, self.column) if n)])

    @property
    def frame(self) -> str:
        """The line with a caret under the column; empty if the place has no text."""
        if not self.text or len(self.text) > _LONGEST_LINE:
            return ""
        number = f"{self.line:>5}"
        blank = " " * len(number)
        return f"\n{number} | {self.text}\n{blank} | {' ' * (self.column - 1)}^"


@dataclass(frozen=True)
class Fault:
    """One mistake: where it stands, what it belongs to, and what to do about it."""

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
    """A mistake of the user or of the world around; never a bug of gaitsim."""

    exit_code = ExitCode.INVALID

    def __init__(self, faults: str | Fault | Iterable[Fault]) -> None:
        if isinstance(faults, str):
            faults = Fault(faults)
        self.faults: tuple[Fault, ...] = (faults,) if isinstance(faults, Fault) else tuple(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))


class InvalidSpec(GaitsimError):
    """The text of a spec, or what it asks for, breaks a rule."""


class InvalidComponent(GaitsimError):
    """A component file breaks the contract."""


class SimulationFailed(GaitsimError):
    """A candidate diverged, or one of its components raised."""

    exit_code = ExitCode.FAILED


class Usage(GaitsimError):
    """The command line does not fit."""

    exit_code = ExitCode.USAGE


class Faults:
    """A collector: a stage reports all its mistakes at once."""

    def __init__(self) -> None:
        self.found: list[Fault] = []

    def add(self, message: str, mark: Mark | None = None, address: str = "") -> None:
        """Add a fault; the same words about the same place, for another address, are one mistake."""
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
    """The known word that was probably meant."""
    near = difflib.get_close_matches(word[:_LONGEST], sorted(known), n=1, cutoff=0.6)
    return near[0] if near else None


def with_article(noun: str) -> str:
    """a muscle, an activation"""
    return f"{'an' if noun[:1] in 'aeiou' else 'a'} {noun}"


def alternatives(words: Iterable[str]) -> str:
    """Words as they are offered: cma, ga, pso or de."""
    *others, last = words
    return " or ".join([", ".join(others), last])


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """A hint at the nearest known word, or the list of all known ones."""
    words = sorted(known)
    near = nearest(word, words)
    if near:
        return f"Did you mean {near}?"
    return f"Known here: {', '.join(words)}." if words else "Nothing is known here."
