"""Signals by name: an address, or a pattern such as 'leg_*.soleus.force'."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from fnmatch import fnmatchcase

from gaitsim.errors import ExitCode, GaitsimError
from gaitsim.model import Model, Signal, recorded_signals
from gaitsim.units import parse_unit

_WILD = frozenset("*?[")
_SHOWN = 5


class NoSuchSignal(GaitsimError):
    """A name matches no recorded signal."""

    exit_code = ExitCode.USAGE


def is_pattern(text: str) -> bool:
    """Whether a text is a pattern, and not one address."""
    return not _WILD.isdisjoint(text)


def matching(model: Model, text: str, arriving: bool = False) -> list[Signal]:
    """Find signals.

    Args:
        model: The model.
        text: An address or a pattern; `*` also matches dots.
        arriving: Whether to search inputs too, which are computed from recorded signals. A pattern matches them only if
            it names them, as 'leg_*.soleus.excitation' does.

    Returns:
        The signals in the order of the model.

    Raises:
        NoSuchSignal: Which offers what is nearest.
    """
    signals = recorded_signals(model)
    if arriving and not is_pattern(text.rpartition(".")[2]):
        signals += _inputs(model)
    if is_pattern(text):
        found = [signal for signal in signals if fnmatchcase(signal.address, text)]
        if not found:
            raise NoSuchSignal(f"{text}: no signal of {model.name} matches this; {_examples(model, text)}.")
        return found
    found = [signal for signal in signals if signal.address == text]
    if not found:
        raise NoSuchSignal(f"{text}: {_missing(model, text, [signal.address for signal in signals])}.")
    return found


def _inputs(model: Model) -> tuple[Signal, ...]:
    """The inputs of parts, in SI; those of a measure are the outputs that it receives."""
    return tuple(
        Signal(f"{part.address}.{name}", parse_unit(port.unit).si, port.doc)
        for part in model.parts
        if not part.measure
        for name, port in part.type.inputs.items()
        if port.unit != "*"
    )


def _missing(model: Model, text: str, known: Sequence[str]) -> str:
    """Why an address is not a signal, and what to write."""
    inside = [address for address in known if address.startswith(f"{text}.")]
    if inside:
        return f"this is a part; its signals are {_listed(inside)}; or write '{text}.*'"
    owner, _, name = text.rpartition(".")
    part = next((part for part in model.parts if part.address == owner), None)
    if part is not None and name in part.type.inputs:
        senders = [c.sender for c in model.connections if c.target == text]
        come = f"it comes from {_listed(senders)}" if senders else "nothing sends to it"
        return f"this is an input, and outputs and states are recorded; {come}"
    if part is not None and name in part.type.parameters:
        return "this is a parameter, which stays what it is during a run; see gaitsim show --parameters"
    if part is not None and name in part.type.states:
        what = "the inside of a measure" if part.measure else "a list of numbers"
        return f"this is {what}, which is not recorded; outputs and plain states are"
    if any(number.address == text for number in model.numbers):
        return "this is a parameter, which stays what it is during a run; see gaitsim show --parameters"
    return f"there is no such signal; the nearest are {_listed(_nearest(text, known))}"


def _nearest(text: str, known: Sequence[str]) -> list[str]:
    """Similar addresses: with the same last word, of the same part, or with similar spelling."""
    word, owner = text.rpartition(".")[2], text.rpartition(".")[0]
    same = [a for a in known if a.rpartition(".")[2] == word or (owner and a.rpartition(".")[0] == owner)]
    alike = difflib.get_close_matches(text, known, n=_SHOWN, cutoff=0.5)
    ranked = sorted({*same, *alike}, key=lambda a: (-difflib.SequenceMatcher(None, a, text).ratio(), a))
    return ranked[:_SHOWN] or list(known[:_SHOWN])


def _examples(model: Model, text: str) -> str:
    known = [signal.address for signal in recorded_signals(model)]
    bare = "".join(letter for letter in text if letter not in "*?[]")
    return f"signals are such as {_listed(_nearest(bare, known))}"


def _listed(addresses: Sequence[str]) -> str:
    first = ", ".join(addresses[:_SHOWN])
    more = len(addresses) - _SHOWN
    return f"{first} and {more} more" if more > 0 else first
