"""Figures of return maps: each maximum of a signal, or each passage of a section, over the one before."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gaitsim.analysis.drawings import style
from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.signals.panels import file_name, finish
from gaitsim.analysis.signals.return_map import FixedPoint, at_passages, fixed_point, maxima
from gaitsim.analysis.signals.selection import has, single, values_of
from gaitsim.errors import ExitCode, GaitsimError
from gaitsim.model import Signal

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]
_EVENTS = 3  # events; they give two points of a return map
_ONE = {"maxima": "maximum", "passages": "passage"}
_SECTION = "measure/section"  # its return map has the signal at its passages


class TooFewEvents(GaitsimError):
    """A run has too few events for a return map."""

    exit_code = ExitCode.USAGE


def return_map(replays: Sequence[Replay], text: str) -> Drawing:
    """Each local maximum of a signal over the previous one, with the diagonal and the fixed point.

    Args:
        replays: The runs.
        text: A signal, or a measure, which stands for the signal that it observes.

    Raises:
        NoSuchSignal: No run has such a signal.
        TooFewEvents: A run has too few events.
    """
    (signal,) = single(replays, _watched(replays, text))
    runs = [(r, m) for r in replays if has(r, signal) for m in [_events(r, signal, text)]]
    what = "passages" if any(_is_section(replay, text) for replay in replays) else "maxima"
    if all(events.size < _EVENTS for _, events in runs):
        counts = ", ".join(f"{replay.label} has {events.size}" for replay, events in runs)
        rule = f"a return map needs {_EVENTS} {what} of {signal.address}, and {counts}"
        move = "simulate longer, such as --set 'simulate.duration=20 s', or name another signal"
        raise TooFewEvents(f"{text}: {rule}; {move}.")
    figure, (axes,) = style.panels(height=4.6)
    summaries, fixed = [], []
    for number, (replay, events) in enumerate(runs):
        if events.size >= _EVENTS:
            fixed.append(fixed_point(events))
            _map_points(axes, events, fixed[-1], number, replay.label)
            summaries.append(f"{replay.label}: {events.size} {what}{_fixed_words(fixed[-1], signal.unit)}")
        else:
            summaries.append(f"{replay.label}: too few {what} ({events.size})")
    _square(axes, np.concatenate([events for _, events in runs if events.size >= _EVENTS]))
    axes.set_xlabel(style.labelled(f"{signal.address}, {_ONE[what]} n", signal.unit))
    axes.set_ylabel(style.labelled(f"{signal.address}, {_ONE[what]} n + 1", signal.unit))
    if any(fixed):
        axes.plot([], [], "*", color="white", markersize=11, markeredgecolor="black", label="fixed point")
    title = f"return map of {signal.address}"
    finish(figure, axes, replays, title)
    if len(replays) == 1:
        style.legend(axes)
    caption = f"{signal.address} ({style.shown_unit(signal.unit)}): {signal.doc} {'; '.join(summaries)}."
    return Drawing(file_name(text, ".return_map", 1), title, caption, figure)


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


def _events(replay: Replay, signal: Signal, text: str) -> Floats:
    values = values_of(replay, signal)
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
