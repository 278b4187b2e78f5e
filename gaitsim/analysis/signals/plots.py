"""Figures of any signal over time or over another signal; several runs over one another."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from gaitsim.analysis.drawings import style
from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.gait.legs import two_legs
from gaitsim.analysis.replays.cycles import last_cycles, thinned
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.signals.panels import caption_of, file_name, finish, label_of, lines_of, name_vertical, pages
from gaitsim.analysis.signals.pattern import NoSuchSignal
from gaitsim.analysis.signals.selection import has, select, single, values_of
from gaitsim.model import Signal, recorded_signals

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CYCLES = 3  # in an overview
_MANY = 16  # signals of one kind in an overview; of more, --plot draws those that are asked for
_OVERVIEW = {  # name of the file: title, kinds of the parts, names of their signals (all if none)
    "motion": ("Coordinates of the joints", ("joint",), ("position", "angle")),
    "ground": ("Forces of the ground", ("contact", "leg"), ("force",)),
    "muscles": ("Muscles", ("muscle",), ("activation", "force")),
    "control": ("What controllers send and remember", ("controller",), ()),
}


def against_time(replays: Sequence[Replay], text: str) -> list[Drawing]:
    """Signals over time, in several figures if they are many.

    For one run, signals with the same unit share a panel. For several runs, there is a panel for each signal and a line
    for each run.

    Args:
        replays: The runs.
        text: An address or a pattern.

    Raises:
        NoSuchSignal: No run has such a signal.
    """
    return _over_time(replays, select(replays, text), text, f"{text} against time", text)


def signal_overlays(replays: Sequence[Replay]) -> list[Drawing]:
    """Joint coordinates, ground forces, muscles and controllers of several runs, over time; of walkers, only the
    first and last.

    Completed runs with cycles are drawn over their last cycles, from touchdown on.
    """
    cycles, period = _last_cycles(replays)
    walking = all(two_legs(replay) for replay in replays)
    drawings = []
    for name, (title, kinds, wanted) in _OVERVIEW.items():
        found: dict[str, Signal] = {}
        for replay in replays:
            mine = {part.address for part in replay.model.parts if part.type.kind in kinds}
            for signal in recorded_signals(replay.model):
                owner, _, word = signal.address.rpartition(".")
                if owner in mine and (not wanted or word in wanted):
                    found.setdefault(signal.address, signal)
        if found and len(found) <= _MANY and not (walking and name in ("ground", "muscles")):
            drawings += _over_time(cycles, list(found.values()), name, f"{title}{period}", "")
    return drawings


def _last_cycles(replays: Sequence[Replay]) -> tuple[Sequence[Replay], str]:
    """Runs with times from a touchdown, and words for that; the whole runs unless all have cycles."""
    spans = [last_cycles(replay, _CYCLES) if replay.outcome.status == "completed" else None for replay in replays]
    parts = [replay.between(*span) for replay, span in zip(replays, spans, strict=True) if span]
    if len(parts) < len(replays):
        return replays, ""
    return [part.counted_from(float(part.times[0])) for part in parts], ", last cycles from touchdown"


def _over_time(replays: Sequence[Replay], signals: Sequence[Signal], name: str, title: str, text: str) -> list[Drawing]:
    drawings = []
    for number, page, heading in pages(replays, signals, title):
        figure, found = style.panels(len(page), share=True)
        for axes, group in zip(found, page, strict=True):
            _time_panel(axes, replays, group)
        found[-1].set_xlabel("time (s)")
        finish(figure, found[0], replays, heading)
        caption = caption_of(replays, [signal for group in page for signal in group], text)
        drawings.append(Drawing(file_name(name, "", number), heading, caption, figure))
    return drawings


def _time_panel(axes: Axes, replays: Sequence[Replay], group: Sequence[Signal]) -> None:
    for look, replay, signal in lines_of(replays, group):
        times, values = thinned(replay.times, values_of(replay, signal))
        drawstyle = "steps-post" if signal.levels else "default"
        label = label_of(replays, replay, signal)
        axes.plot(times, values, **look, linewidth=1.1, drawstyle=drawstyle, label=label)
        if replay.ending and replay.reaches_end:
            axes.plot(times[-1:], values[-1:], **look, marker="x", markersize=6)
    axes.margins(x=0.01)
    name_vertical(axes, replays, group)


def against_signal(replays: Sequence[Replay], text: str, other: str) -> list[Drawing]:
    """Signals over another signal, in the order of time.

    Args:
        replays: The runs.
        text: An address or a pattern.
        other: The signal on the horizontal axis.

    Raises:
        NoSuchSignal: No run has such a signal.
    """
    (horizontal,) = single(replays, other)
    signals = [signal for signal in select(replays, text) if signal.address != horizontal.address]
    if not signals:
        raise NoSuchSignal(f"{text}: this is the signal that it would be drawn against; name another.")
    drawings = []
    for number, page, title in pages(replays, signals, f"{text} against {other}"):
        figure, found = style.panels(len(page), height=3.2 if len(page) == 1 else 2.4, share=True)
        for axes, group in zip(found, page, strict=True):
            for look, replay, signal in lines_of(replays, group):
                if has(replay, horizontal):
                    x, y = values_of(replay, horizontal), values_of(replay, signal)
                    axes.plot(x, y, **look, linewidth=1, label=label_of(replays, replay, signal))
                    axes.plot(x[:1], y[:1], **look, marker="o", markersize=4)
            name_vertical(axes, replays, group)
        found[-1].set_xlabel(style.labelled(horizontal.address, horizontal.unit))
        finish(figure, found[0], replays, title)
        caption = caption_of(replays, [horizontal, *(s for group in page for s in group)], text)
        name = file_name(text, f".against.{other}", number)
        drawings.append(Drawing(name, title, f"{caption} A dot marks the first instant.", figure))
    return drawings
