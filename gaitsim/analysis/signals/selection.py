"""The signals that a text names in several runs, and their values."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gaitsim.analysis.replays.cycles import arriving
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.signals.pattern import NoSuchSignal, matching
from gaitsim.model import Signal

Floats = NDArray[np.float64]


def select(replays: Sequence[Replay], text: str) -> list[Signal]:
    """The signals that a text names in any of the runs.

    Raises:
        NoSuchSignal: None has one.
    """
    found: dict[str, Signal] = {}
    error: NoSuchSignal | None = None
    for replay in replays:
        try:
            found |= {s.address: s for s in matching(replay.model, text, arriving=True) if s.address not in found}
        except NoSuchSignal as missing:
            error = error or missing
    if not found and error is not None:
        raise error
    return list(found.values())


def runs_without(replays: Sequence[Replay], text: str) -> list[str]:
    """The labels of the runs in which a text names nothing."""
    found = []
    for replay in replays:
        try:
            matching(replay.model, text, arriving=True)
        except NoSuchSignal:
            found.append(replay.label)
    return found


def single(replays: Sequence[Replay], text: str) -> list[Signal]:
    """Find the one signal that a text names.

    Raises:
        NoSuchSignal: Unless a text names one signal.
    """
    found = select(replays, text)
    if len(found) > 1:
        raise NoSuchSignal(f"{text}: this must be one signal, and it matches {len(found)}; write one address.")
    return found


def has(replay: Replay, signal: Signal) -> bool:
    owner, _, name = signal.address.rpartition(".")
    ports = (part.type.inputs for part in replay.model.parts if part.address == owner)
    return signal.address in replay.trajectory.signals or any(name in inputs for inputs in ports)


def values_of(replay: Replay, signal: Signal) -> Floats:
    """The recorded values of a signal, or the values of an input."""
    if signal.address in replay.trajectory.signals:
        return replay.trajectory[signal.address]
    return arriving(replay, signal.address)
