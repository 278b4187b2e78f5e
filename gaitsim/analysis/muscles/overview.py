"""Figures of all muscles of a leg: their signals over time, and their excitations."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import FONT, GREY, labelled, look, panels
from gaitsim.analysis.gait.legs import SIDES, side_of, unsided
from gaitsim.analysis.replays.cycles import Floats, sent, shade_stance, shown_part, thinned
from gaitsim.analysis.replays.replay import Replay

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    _Draw = Callable[[Axes, Replay, Replay, str], None]

_COLUMNS = 2
_ROW = 0.17  # of a panel's height, for one row of its legend
_TIGHT: dict[str, Any] = {
    "frameon": False,
    "borderpad": 0,
    "labelspacing": 0.15,
    "columnspacing": 1,
    "handlelength": 1.2,
}
_LARGEST = 1.5  # of what is drawn of an excitation, either way


def overview_figures(replay: Replay) -> list[Drawing]:
    """The signals and the excitations of the muscles of each leg, and of muscles without a side."""
    found = []
    for side, muscles in _groups(replay).items():
        of = f" of the {SIDES[side]} leg" if side else ""
        end = f"_{side}" if side else ""
        found.append(_overview(replay, muscles, f"muscles{end}", f"Muscles{of}", _SIGNALS, _draw_signals))
        found.append(
            _overview(replay, muscles, f"excitations{end}", f"What excites the muscles{of}", _SENT, _draw_sent)
        )
    return found


_SIGNALS = (
    "activation, force over the largest isometric force, and fiber length over the optimal one (dotted line at 1, "
    "all plain numbers)"
)
_SENT = (
    f"what arrives at each muscle's excitation, sender by sender, drawn from {-_LARGEST:g} to {_LARGEST:g}; the muscle "
    "limits their sum"
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
    part, said = shown_part(replay, address=muscles[0])
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
        f"{', '.join(muscles)} over {said}: {what}.{' Grey: stance.' if shaded else ''} A muscle's own figures come "
        f"with --plot {muscles[0]}."
    )
    return Drawing(name, title, caption, figure)


def _name_lines(figure: Figure, axes: list[Axes]) -> None:
    """Add one legend above all panels if their lines have the same names, else one in each."""
    named = [panel.get_legend_handles_labels() for panel in axes]
    if all(labels == named[0][1] for _, labels in named):
        figure.legend(*named[0], loc="outside upper right", ncols=3, frameon=False, fontsize=FONT - 1)
        return
    for panel, (handles, labels) in zip(axes, named, strict=True):
        if labels:
            low, high = panel.get_ylim()
            rows = -(-len(labels) // 2)
            panel.set_ylim(low, high + _ROW * rows * (high - low))
            panel.legend(handles, labels, fontsize=FONT - 3, ncols=2, loc="upper right", **_TIGHT)


def _draw_signals(panel: Axes, _: Replay, part: Replay, muscle: str) -> None:
    for number, word in enumerate(("activation", "normalized_force", "normalized_fiber_length")):
        values = part.trajectory[f"{muscle}.{word}"]
        panel.plot(*thinned(part.times, values, 600), linewidth=1.1, label=word.replace("_", " "), **look(number))
    panel.axhline(1, color=GREY, linewidth=0.8, linestyle=":")


def _draw_sent(panel: Axes, replay: Replay, part: Replay, muscle: str) -> None:
    kept = (replay.times >= part.times[0]) & (replay.times <= part.times[-1])
    model = replay.model
    for number, connection in enumerate(c for c in model.connections if c.target == f"{muscle}.excitation"):
        values: Floats = np.clip(sent(replay, connection)[kept], -_LARGEST, _LARGEST)
        sender = unsided(connection.sender.rpartition(".")[0])
        panel.plot(*thinned(part.times, values, 600), linewidth=1.1, label=sender.replace("_", " "), **look(number))
