"""Figures of all muscles of a leg: their signals over time, and their excitations."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import FONT, GREY, columns_of, labelled, look, panels
from gaitsim.analysis.gait.legs import SIDES, side_of, unsided
from gaitsim.analysis.replays.cycles import Floats, sent, shade_stance, shown_part, thinned
from gaitsim.analysis.replays.replay import Replay
from gaitsim.model import Connection

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    _Draw = Callable[[Axes, Replay, Replay, str], None]

_COLUMNS = 2
_ROW = 0.17  # inches: a row of the legend
_LARGEST = 1.5  # of what is drawn of an excitation, either way


def overview_figures(replay: Replay) -> list[Drawing]:
    """The signals and the excitations of the muscles of each leg, and of muscles without a side."""
    found = []
    for side, muscles in _groups(replay).items():
        of = f" of the {SIDES[side]} leg" if side else ""
        end = f"_{side}" if side else ""
        found.append(_overview(replay, muscles, f"muscles{end}", f"Muscles{of}", _SIGNALS, _draw_signals))
        draw = partial(_draw_sent, _sender_looks(replay, muscles))
        found.append(_overview(replay, muscles, f"excitations{end}", f"What excites the muscles{of}", _SENT, draw))
    return found


_SIGNALS = (
    "activation, force over the largest isometric force, and fiber length over the optimal one (dotted line at 1, "
    "all plain numbers)"
)
_SENT = (
    "what arrives at each muscle's excitation, sender by sender (without the muscle's name), drawn from "
    f"{-_LARGEST:g} to {_LARGEST:g}; the muscle limits their sum"
)


def _groups(replay: Replay) -> dict[str, list[str]]:
    """The addresses of muscles by side; the empty side has those of no leg."""
    found: dict[str, list[str]] = {}
    for part in replay.model.parts:
        if part.type.kind == "muscle":
            found.setdefault(side_of(part.address), []).append(part.address)
    return found


def _overview(replay: Replay, muscles: list[str], name: str, title: str, what: str, draw: _Draw) -> Drawing:
    """A panel for each muscle, over the last cycles of its leg."""
    part, period = shown_part(replay, address=muscles[0])
    figure, axes = panels(-(-len(muscles) // _COLUMNS), _COLUMNS, height=1.5, share=True)
    shaded = False
    for panel, muscle in zip(axes, muscles, strict=False):
        draw(panel, replay, part, muscle)
        shaded = shade_stance(panel, part, muscle) or shaded
        panel.set_title(unsided(muscle).replace("_", " "), loc="left", fontsize=FONT)
        panel.margins(x=0)
    _name_lines(figure, axes[: len(muscles)])
    for unused in axes[len(muscles) :]:
        unused.set_axis_off()
    for panel in axes[: len(muscles)][-_COLUMNS:]:
        panel.tick_params(labelbottom=True)
    figure.supxlabel(labelled("time", "s"), fontsize=FONT)
    figure.supylabel(labelled("value", "1"), fontsize=FONT)
    caption = (
        f"{', '.join(muscles)} over {period}: {what}.{' Grey: stance.' if shaded else ''} A muscle's own figures come "
        f"with --plot {muscles[0]}."
    )
    return Drawing(name, title, caption, figure)


def _name_lines(figure: Figure, axes: list[Axes]) -> None:
    """Add one legend for all panels, above them. A line has the same look in each."""
    lines = {}
    for panel in axes:
        handles, labels = panel.get_legend_handles_labels()
        lines.update({label: handle for label, handle in zip(labels, handles, strict=True) if label not in lines})
    if lines:
        columns = columns_of(lines)
        figure.set_figheight(figure.get_figheight() + _ROW * -(-len(lines) // columns))
        options: dict[str, Any] = {"ncols": columns, "frameon": False, "fontsize": FONT - 1}
        figure.legend(list(lines.values()), list(lines), loc="outside upper right", **options)


def _draw_signals(panel: Axes, _: Replay, part: Replay, muscle: str) -> None:
    for number, word in enumerate(("activation", "normalized_force", "normalized_fiber_length")):
        values = part.trajectory[f"{muscle}.{word}"]
        panel.plot(*thinned(part.times, values, 600), linewidth=1.1, label=word.replace("_", " "), **look(number))
    panel.axhline(1, color=GREY, linewidth=0.8, linestyle=":")


def _sender_looks(replay: Replay, muscles: Sequence[str]) -> dict[str, dict[str, Any]]:
    """The look of the line of each sender, by the name that the figure gives it."""
    names = dict.fromkeys(name for muscle in muscles for _, name in _senders(replay, muscle))
    return {name: look(number) for number, name in enumerate(names)}


def _senders(replay: Replay, muscle: str) -> list[tuple[Connection, str]]:
    """The connections to the excitation of a muscle, and the names of their senders."""
    connections = [c for c in replay.model.connections if c.target == f"{muscle}.excitation"]
    parts = [unsided(connection.sender.rpartition(".")[0]).replace("_", " ") for connection in connections]
    short = [_short(part, unsided(muscle).replace("_", " ")) for part in parts]
    return list(zip(connections, short if len(set(short)) == len(set(parts)) else parts, strict=True))


def _short(sender: str, muscle: str) -> str:
    """The name of a sender without the name of its muscle: swing bias instead of gluteus swing bias."""
    words = sender.rpartition(".")[2].split(" ")
    while len(words) > 1 and words[0] in muscle.split(" "):
        del words[0]
    return " ".join(words)


def _draw_sent(looks: Mapping[str, dict[str, Any]], panel: Axes, replay: Replay, part: Replay, muscle: str) -> None:
    inside = (replay.times >= part.times[0]) & (replay.times <= part.times[-1])
    for connection, name in _senders(replay, muscle):
        values: Floats = np.clip(sent(replay, connection)[inside], -_LARGEST, _LARGEST)
        panel.plot(*thinned(part.times, values, 600), linewidth=1.1, label=name, **looks[name])
