"""Stance and flight of a model, and its cycles from touchdown to touchdown."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gaitsim.analysis.drawings.style import GREY
from gaitsim.analysis.replays.replay import Replay
from gaitsim.model import Connection

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
Span = tuple[float, float]

_CONTACTS = ("in_contact", "in_stance")
_LEAST_FLIGHT = 0.25  # of the longest flight; a contact that follows sooner is a bounce of the one before


def arriving(replay: Replay, port: str) -> Floats:
    """The value of an input at every instant: its constant or the sum of its senders, with their delays.

    Returns:
        One value for each instant; nan where a delayed signal lies before the first one.
    """
    model, times = replay.model, replay.times
    values = model.values()
    owner, _, name = port.rpartition(".")
    part = next(part for part in model.parts if part.address == owner)
    senders = [connection for connection in model.connections if connection.target == port]
    if not senders:
        default = part.type.inputs[name].default or 0.0
        return np.full(len(times), values[part.constants[name]] if name in part.constants else default)
    return sum((sent(replay, connection) for connection in senders), np.zeros(len(times)))


def sent(replay: Replay, connection: Connection) -> Floats:
    """The contribution of one sender, with its delay; nan before the first instant."""
    times, signal = replay.times, replay.trajectory[connection.sender]
    values = replay.model.values()
    delay = 0.0 if connection.delay is None else values[connection.delay]
    if delay == 0 or not len(times):
        return signal
    before = signal[0] if connection.initial is None else values[connection.initial]
    return np.interp(times - delay, times, signal, left=before if times[0] == 0 else np.nan)


def stance(replay: Replay, address: str = "") -> Floats | None:
    """The stance of a model.

    Args:
        replay: The run.
        address: An address whose side counts, if that has contacts of its own.

    Returns:
        1 while a contact or a leg is loaded, else 0; None if nothing in the model can be.
    """
    signals = [s for s in replay.trajectory.signals if s.rpartition(".")[2] in _CONTACTS]
    own = [s for s in signals if "." in address and s.startswith(address.split(".")[0] + ".")]
    chosen = own or signals
    if not chosen:
        return None
    return np.asarray(np.max([replay.trajectory[s] for s in chosen], axis=0), dtype=np.float64)


def touchdowns(times: Floats, standing: Floats) -> list[int]:
    """The instants at which a flight ends. Flights shorter than a quarter of the longest are bounces of the foot and
    do not count.
    """
    down = standing > 0.5
    landings = np.flatnonzero(down[1:] & ~down[:-1]) + 1
    leavings = np.flatnonzero(~down[1:] & down[:-1]) + 1
    left = [leavings[leavings < landing] for landing in landings]
    flights = [times[i] - times[before[-1] if before.size else 0] for i, before in zip(landings, left, strict=True)]
    least = _LEAST_FLIGHT * max(flights, default=0.0)
    return [int(i) for i, flight in zip(landings, flights, strict=True) if flight >= least]


def last_cycles(replay: Replay, count: int, address: str = "") -> Span | None:
    """The times of two touchdowns, the last one and that `count` cycles before, or of as many as there are; None
    without a cycle.
    """
    standing = stance(replay, address)
    if standing is None or len(standing) < 2:
        return None
    found = touchdowns(replay.times, standing)
    if len(found) < 2:
        return None
    first = found[-min(count, len(found) - 1) - 1]
    return float(replay.times[first]), float(replay.times[found[-1]])


def shown_part(replay: Replay, count: int = 3, address: str = "") -> tuple[Replay, str]:
    """The last cycles of a run, or all of it, and the words for it in a caption."""
    span = last_cycles(replay, count, address)
    if span is None or replay.outcome.status == "failed":
        return replay, "the whole run"
    cycles = min(count, len(_touchdowns_of(replay, address)) - 1)
    period = f"the last {cycles} cycles" if cycles > 1 else "the last cycle"
    return replay.between(*span), f"{period} from touchdown to touchdown"


def _touchdowns_of(replay: Replay, address: str) -> Sequence[int]:
    standing = stance(replay, address)
    return [] if standing is None else touchdowns(replay.times, standing)


def shade_stance(axes: Axes, replay: Replay, address: str = "") -> bool:
    """Shade the stance of the model.

    Returns:
        Whether there is any.
    """
    standing = stance(replay, address)
    if standing is None or not (standing > 0.5).any():
        return False
    down = standing > 0.5
    edges = np.flatnonzero(down[1:] != down[:-1]) + 1
    bounds = [0, *edges.tolist(), len(down) - 1]
    for begin, end in pairwise(bounds):
        if down[begin]:
            axes.axvspan(replay.times[begin], replay.times[end], color=GREY, alpha=0.15, linewidth=0, zorder=0)
    return True


def thinned(times: Floats, values: Floats, limit: int = 2400) -> tuple[Floats, Floats]:
    """A line with fewer points that looks the same: the lowest and the highest point of each section."""
    if len(times) <= limit:
        return times, values
    stretches = np.array_split(np.arange(len(times)), limit // 2)
    extremes = sorted({int(i) for s in stretches for i in (s[np.argmin(values[s])], s[np.argmax(values[s])])})
    chosen = np.array([0, *[i for i in extremes if 0 < i < len(times) - 1], len(times) - 1])
    return times[chosen], values[chosen]
