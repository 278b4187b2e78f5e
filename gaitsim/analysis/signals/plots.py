"""Figures of any signal over time, over another signal, and as a return map; several runs over one another."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gaitsim.analysis.drawings import style
from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.gait.legs import two_legs
from gaitsim.analysis.replays.cycles import arriving, last_cycles, thinned
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.signals.pattern import NoSuchSignal, matching
from gaitsim.analysis.signals.return_map import FixedPoint, at_passages, fixed_point, maxima
from gaitsim.errors import ExitCode, GaitsimError
from gaitsim.model import Signal, recorded_signals

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]
_LINES = 4  # in one panel
_PANELS = 4  # in one figure
_CYCLES = 3  # in an overview
_EVENTS = 3  # events; they give two points of a return map
_ONE = {"maxima": "maximum", "passages": "passage"}
_SECTION = "measure/section"  # its return map has the signal at its passages
_MANY = 16  # signals of one kind in an overview; of more, --plot draws those that are asked for
_OVERVIEW = {  # name of the file: title, kinds of the parts, names of their signals (all if none)
    "motion": ("Coordinates of the joints", ("joint",), ("position", "angle")),
    "ground": ("Forces of the ground", ("contact", "leg"), ("force",)),
    "muscles": ("Muscles", ("muscle",), ("activation", "force")),
    "control": ("What controllers send and remember", ("controller",), ()),
}


class TooFewEvents(GaitsimError):
    """A run has too few events for a return map."""

    exit_code = ExitCode.USAGE


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
    return _over_time(replays, chosen(replays, text), text, f"{text} against time", text)


def signal_overlays(replays: Sequence[Replay]) -> list[Drawing]:
    """Joint coordinates, ground forces, muscles and controllers of several runs, over time; of walkers, only the
    first and last.

    Completed runs with cycles are drawn over their last cycles, from touchdown on.
    """
    drawn, said = _last_cycles(replays)
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
            drawings += _over_time(drawn, list(found.values()), name, f"{title}{said}", "")
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
    for number, page, heading in _pages(replays, signals, title):
        figure, found = style.panels(len(page), share=True)
        for axes, group in zip(found, page, strict=True):
            _time_panel(axes, replays, group)
        found[-1].set_xlabel("time (s)")
        _finish(figure, found[0], replays, heading)
        caption = _caption(replays, [signal for group in page for signal in group], text)
        drawings.append(Drawing(_file_name(name, "", number), heading, caption, figure))
    return drawings


def _pages(
    replays: Sequence[Replay], signals: Sequence[Signal], title: str
) -> Iterator[tuple[int, list[list[Signal]], str]]:
    """Number, panels and title of each figure."""
    panels = [[signal] for signal in signals] if len(replays) > 1 else list(_by_unit(signals))
    pages = [panels[i : i + _PANELS] for i in range(0, len(panels), _PANELS)]
    for number, page in enumerate(pages, start=1):
        yield number, page, title + (f" ({number} of {len(pages)})" if len(pages) > 1 else "")


def against_signal(replays: Sequence[Replay], text: str, other: str) -> list[Drawing]:
    """Signals over another signal, in the order of time.

    Args:
        replays: The runs.
        text: An address or a pattern.
        other: The signal on the horizontal axis.

    Raises:
        NoSuchSignal: No run has such a signal.
    """
    (horizontal,) = _single(replays, other)
    signals = [signal for signal in chosen(replays, text) if signal.address != horizontal.address]
    if not signals:
        raise NoSuchSignal(f"{text}: this is the signal that it would be drawn against; name another.")
    drawings = []
    for number, page, title in _pages(replays, signals, f"{text} against {other}"):
        figure, found = style.panels(len(page), height=3.2 if len(page) == 1 else 2.4, share=True)
        for axes, group in zip(found, page, strict=True):
            for look, replay, signal in _lines(replays, group):
                if _has(replay, horizontal):
                    x, y = _values(replay, horizontal), _values(replay, signal)
                    axes.plot(x, y, **look, linewidth=1, label=_label(replays, replay, signal))
                    axes.plot(x[:1], y[:1], **look, marker="o", markersize=4)
            _name_vertical(axes, replays, group)
        found[-1].set_xlabel(style.labelled(horizontal.address, horizontal.unit))
        _finish(figure, found[0], replays, title)
        caption = _caption(replays, [horizontal, *(s for group in page for s in group)], text)
        name = _file_name(text, f".against.{other}", number)
        drawings.append(Drawing(name, title, f"{caption} A dot marks the first instant.", figure))
    return drawings


def return_map(replays: Sequence[Replay], text: str) -> Drawing:
    """Each local maximum of a signal over the previous one, with the diagonal and the fixed point.

    Args:
        replays: The runs.
        text: A signal, or a measure, which stands for the signal that it observes.

    Raises:
        NoSuchSignal: No run has such a signal.
        TooFewEvents: A run has too few events.
    """
    (signal,) = _single(replays, _watched(replays, text))
    runs = [(r, m) for r in replays if _has(r, signal) for m in [_events(r, signal, text)]]
    what = "passages" if any(_is_section(replay, text) for replay in replays) else "maxima"
    if all(events.size < _EVENTS for _, events in runs):
        counts = ", ".join(f"{replay.label} has {events.size}" for replay, events in runs)
        rule = f"a return map needs {_EVENTS} {what} of {signal.address}, and {counts}"
        move = "simulate longer, such as --set 'simulate.duration=20 s', or name another signal"
        raise TooFewEvents(f"{text}: {rule}; {move}.")
    figure, (axes,) = style.panels(height=4.6)
    words, fixed = [], []
    for number, (replay, events) in enumerate(runs):
        if events.size >= _EVENTS:
            fixed.append(fixed_point(events))
            _map_points(axes, events, fixed[-1], number, replay.label)
            words.append(f"{replay.label}: {events.size} {what}{_fixed_words(fixed[-1], signal.unit)}")
        else:
            words.append(f"{replay.label}: too few {what} ({events.size})")
    _square(axes, np.concatenate([events for _, events in runs if events.size >= _EVENTS]))
    axes.set_xlabel(style.labelled(f"{signal.address}, {_ONE[what]} n", signal.unit))
    axes.set_ylabel(style.labelled(f"{signal.address}, {_ONE[what]} n + 1", signal.unit))
    if any(fixed):
        axes.plot([], [], "*", color="white", markersize=11, markeredgecolor="black", label="fixed point")
    title = f"return map of {signal.address}"
    _finish(figure, axes, replays, title)
    if len(replays) == 1:
        style.legend(axes)
    caption = f"{signal.address} ({style.shown_unit(signal.unit)}): {signal.doc} {'; '.join(words)}."
    return Drawing(_file_name(text, ".return_map", 1), title, caption, figure)


def _watched(replays: Sequence[Replay], text: str) -> str:
    """The signal that a measure observes; the text itself if it is not a measure."""
    for replay in replays:
        measures = [part for part in replay.model.parts if part.address == text and part.measure]
        inputs = ["signal"] if _is_section(replay, text) else [name for part in measures for name in part.type.inputs]
        ports = {f"{text}.{name}" for name in inputs}
        sender = next((c.sender for c in replay.model.connections if c.target in ports), None)
        if sender is not None:
            return sender
    return text


def _has(replay: Replay, signal: Signal) -> bool:
    owner, _, name = signal.address.rpartition(".")
    ports = (part.type.inputs for part in replay.model.parts if part.address == owner)
    return signal.address in replay.trajectory.signals or any(name in inputs for inputs in ports)


def _values(replay: Replay, signal: Signal) -> Floats:
    """The recorded values of a signal, or the values of an input."""
    if signal.address in replay.trajectory.signals:
        return replay.trajectory[signal.address]
    return arriving(replay, signal.address)


def _events(replay: Replay, signal: Signal, text: str) -> Floats:
    values = _values(replay, signal)
    return (
        at_passages(values, replay.trajectory[f"{text}.guard"]) if _is_section(replay, text) else values[maxima(values)]
    )


def _is_section(replay: Replay, text: str) -> bool:
    return any(part.address == text and part.type.reference == _SECTION for part in replay.model.parts)


def _map_points(axes: Axes, events: Floats, found: FixedPoint | None, number: int, label: str) -> None:
    colour = style.look(number)["color"]
    axes.plot(events[:-1], events[1:], "o", color=colour, markersize=4, alpha=0.8, label=label)
    walk = np.repeat(events, 2)
    axes.plot(walk[:-2], walk[1:-1], color=colour, linewidth=0.6, alpha=0.5)
    if found is not None:
        place = [found.value]
        axes.plot(place, place, "*", color=colour, markersize=13, markeredgecolor="black", label=f"_{label}")


def _fixed_words(found: FixedPoint | None, unit: str) -> str:
    if found is None:
        return ", no fixed point among them"
    value = f"{found.value:.5g}{'' if unit == '1' else f' {style.shown_unit(unit)}'}"
    if found.slope is None:
        return f", fixed point at {value}"
    kind = "stable" if abs(found.slope) < 1 else "not stable"
    return f", fixed point at {value} with slope {found.slope:.2g}, {kind}"


def _square(axes: Axes, events: Floats) -> None:
    """Equal axes with the diagonal, not narrower than the accuracy of the numbers."""
    low, high = float(events.min()), float(events.max())
    margin = max(0.08 * (high - low), 1e-3 * max(abs(low), abs(high)))
    limits = (low - margin, high + margin)
    axes.plot(limits, limits, color=style.GREY, linewidth=0.8, label="diagonal")
    axes.set_xlim(*limits)
    axes.set_ylim(*limits)
    axes.set_aspect("equal")
    axes.ticklabel_format(useOffset=False)


def chosen(replays: Sequence[Replay], text: str) -> list[Signal]:
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


def lacking(replays: Sequence[Replay], text: str) -> list[str]:
    """The labels of the runs in which a text names nothing."""
    found = []
    for replay in replays:
        try:
            matching(replay.model, text, arriving=True)
        except NoSuchSignal:
            found.append(replay.label)
    return found


def _single(replays: Sequence[Replay], text: str) -> list[Signal]:
    """Find the one signal that a text names.

    Raises:
        NoSuchSignal: Unless a text names one signal.
    """
    found = chosen(replays, text)
    if len(found) > 1:
        raise NoSuchSignal(f"{text}: this must be one signal, and it matches {len(found)}; write one address.")
    return found


def _by_unit(signals: Sequence[Signal]) -> Iterator[list[Signal]]:
    groups: dict[tuple[str, tuple[str, ...]], list[Signal]] = {}
    for signal in signals:
        groups.setdefault((signal.unit, signal.levels), []).append(signal)
    for group in groups.values():
        for i in range(0, len(group), _LINES):
            yield group[i : i + _LINES]


def _lines(replays: Sequence[Replay], group: Sequence[Signal]) -> Iterator[tuple[dict[str, Any], Replay, Signal]]:
    """The lines of a panel. Colours distinguish the signals of one run, or several runs."""
    for r, replay in enumerate(replays):
        for s, signal in enumerate(group):
            if _has(replay, signal):
                yield style.look(r if len(replays) > 1 else s), replay, signal


def _time_panel(axes: Axes, replays: Sequence[Replay], group: Sequence[Signal]) -> None:
    for look, replay, signal in _lines(replays, group):
        times, values = thinned(replay.times, _values(replay, signal))
        drawn = "steps-post" if signal.levels else "default"
        label = _label(replays, replay, signal)
        axes.plot(times, values, **look, linewidth=1.1, drawstyle=drawn, label=label)
        if replay.ending and replay.reaches_end:
            axes.plot(times[-1:], values[-1:], **look, marker="x", markersize=6)
    axes.margins(x=0.01)
    _name_vertical(axes, replays, group)


def _label(replays: Sequence[Replay], replay: Replay, signal: Signal) -> str:
    return replay.label if len(replays) > 1 else signal.address


def _owner(group: Sequence[Signal]) -> str:
    """The part of all signals in a panel, with a dot at its end; empty if they belong to several."""
    owners = {signal.address.rpartition(".")[0] for signal in group}
    return f"{owners.pop()}." if len(owners) == 1 else ""


def _name_vertical(axes: Axes, replays: Sequence[Replay], group: Sequence[Signal]) -> None:
    first = group[0]
    words = {signal.address.rpartition(".")[2] for signal in group}
    if len(group) == 1:
        name = first.address
    else:
        name = words.pop().replace("_", " ") if len(words) == 1 else f"{_owner(group)} {style.quantity(first.unit)}"
    axes.set_ylabel("\n".join(_wrapped(name)) + f"\n({style.shown_unit(first.unit)})", fontsize=style.FONT)
    if first.levels:
        axes.set_yticks(range(len(first.levels)), first.levels)
    if len(group) > 1 and len(replays) == 1:
        handles, labels = axes.get_legend_handles_labels()
        short = [label.removeprefix(_owner(group)) for label in labels]
        columns = max(1, min(len(short), 88 // (max(map(len, short)) + 8)))
        style.legend(
            axes,
            handles=handles,
            labels=short,
            loc="lower left",
            bbox_to_anchor=(0, 1),
            ncols=columns,
            frameon=False,
            borderaxespad=0.2,
        )


def _wrapped(name: str) -> list[str]:
    """An address in pieces that fit the height of a panel, divided after dots."""
    lines = [""]
    for piece in re.findall(r"[^. ]+[. ]?", name):
        if lines[-1] and len(lines[-1]) + len(piece) > 24:
            lines.append("")
        lines[-1] += piece
    return lines


def _finish(figure: Figure, first: Axes, replays: Sequence[Replay], title: str) -> None:
    """Add a heading that says how runs ended, and one legend for several runs."""
    if len(replays) == 1:
        title = f"{title}, {replays[0].label}"
    endings = [f"{replay.label} {replay.ending}" for replay in replays if replay.ending]
    lines = [title, *(textwrap.shorten(ending, 100) for ending in endings)]
    figure.suptitle("\n".join(textwrap.fill(line, 92) for line in lines), fontsize=style.FONT)
    if len(replays) > 1:
        handles, labels = first.get_legend_handles_labels()
        columns = 1 if max(map(len, labels), default=0) > 36 else 2
        figure.legend(handles, labels, loc="outside lower center", ncols=columns, fontsize=style.FONT - 1)


def _caption(replays: Sequence[Replay], signals: Sequence[Signal], text: str) -> str:
    words = [f"{signal.address} ({style.shown_unit(signal.unit)}): {signal.doc}" for signal in signals]
    words += [f"{label} has no such signal." for label in (lacking(replays, text) if text else ())]
    words += [f"{replay.label} {replay.ending}." for replay in replays if replay.ending]
    return " ".join(words)


def _file_name(text: str, rest: str, number: int) -> str:
    plain = re.sub(r"[^\w.-]+", "_", f"{text.replace('*', 'all')}{rest}")
    return plain if number == 1 else f"{plain}_{number}"
