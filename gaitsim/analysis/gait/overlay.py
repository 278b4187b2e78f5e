"""The gaits of several walkers over one another: a line for each run, a column for each leg, with people's data."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import FONT, LINES, PALETTE, labelled, panels, shown_unit
from gaitsim.analysis.gait.comparison import ComparedQuantity, matched_moments, matched_signals
from gaitsim.analysis.gait.legs import PERCENT, SIDES, Cycle, Leg, two_legs
from gaitsim.analysis.gait.muscles import sided_muscles
from gaitsim.analysis.gait.norms import Norm
from gaitsim.analysis.gait.panels import PEOPLE, draw_people
from gaitsim.analysis.replays.replay import Replay
from gaitsim.units import parse_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLOURS = tuple(colour for colour in PALETTE if colour != PEOPLE)
_ROWS = 4  # in one figure
Legs = Sequence[Leg]


@dataclass(frozen=True)
class Curve:
    """One quantity of one run over the gait cycle.

    Attributes:
        unit: The unit in which it is drawn; empty if the name contains it.
        cycles: By side, in SI.
    """

    name: str
    unit: str
    cycles: Mapping[str, Cycle]
    norm: Norm | None = None

    @property
    def factor(self) -> float:
        """The factor from SI to the unit."""
        return 1 / parse_unit(self.unit).factor if self.unit else 1.0

    @property
    def axis(self) -> str:
        """The label of its axis, in short lines."""
        lines = textwrap.wrap(self.name, 18)
        return "\n".join([*lines, f"({shown_unit(self.unit)})"] if self.unit else lines)


_Curves = Callable[[Replay, Legs], list[Curve]]


def gait_overlays(replays: Sequence[Replay]) -> list[Drawing]:
    """Joint angles, ground forces, joint moments and activations of several runs over one another.

    Args:
        replays: Any number of runs. Those that do not walk on two legs are left out, and the caption names them.

    Returns:
        Figures with a line for each run, the mean over its strides; none unless two of the runs walk.
    """
    walkers = [(replay, legs) for replay in replays if (legs := two_legs(replay)) is not None]
    if len(walkers) < 2:
        return []
    others = [replay.label for replay in replays if two_legs(replay) is None]
    return [drawing for overlay in _OVERLAYS for drawing in _drawings(overlay, walkers, others)]


def _matched(found: Sequence[ComparedQuantity], unit: str = "") -> list[Curve]:
    return [Curve(one.name, unit or one.norm.unit, one.cycles, one.norm) for one in found]


def _angles(replay: Replay, legs: Legs) -> list[Curve]:
    return _matched(matched_signals(replay, legs))


def _moments(replay: Replay, legs: Legs) -> list[Curve]:
    return _matched(matched_moments(replay, legs), "N m/kg")


def _forces(_: Replay, legs: Legs) -> list[Curve]:
    return [
        Curve("vertical (body weights)", "", {leg.side: leg.over_cycle(leg.load) for leg in legs}),
        Curve("forwards (body weights)", "", {leg.side: leg.over_cycle(leg.shear) for leg in legs}),
    ]


def _activations(replay: Replay, legs: Legs) -> list[Curve]:
    return [
        Curve(
            name.replace("_", " "),
            "1",
            {leg.side: leg.over_cycle(replay.trajectory[f"{pair[leg.side]}.activation"]) for leg in legs},
        )
        for name, pair in sided_muscles(replay).items()
    ]


@dataclass(frozen=True)
class _Overlay:
    """One kind of figure.

    Attributes:
        name: The name of its file.
    """

    name: str
    title: str
    caption: str
    curves: _Curves


_OVERLAYS = (
    _Overlay("overlaid_angles", "Joint angles", "", _angles),
    _Overlay(
        "overlaid_forces",
        "Ground reaction forces",
        " Along the ground's normal, and forwards along the ground.",
        _forces,
    ),
    _Overlay(
        "overlaid_moments", "Joint moments", " Over body mass; extension and plantarflexion are positive.", _moments
    ),
    _Overlay("overlaid_activations", "Muscle activations", "", _activations),
)


def _drawings(overlay: _Overlay, walkers: Sequence[tuple[Replay, Legs]], others: Sequence[str]) -> Iterator[Drawing]:
    """The figures of one kind, with a few quantities each."""
    runs = [(replay.label, {one.name: one for one in overlay.curves(replay, legs)}) for replay, legs in walkers]
    names = list(dict.fromkeys(name for _, curves in runs for name in curves))
    pages = [names[i : i + _ROWS] for i in range(0, len(names), _ROWS)]
    for number, page in enumerate(pages, start=1):
        of = f" ({number} of {len(pages)})" if len(pages) > 1 else ""
        name = overlay.name if len(pages) == 1 else f"{overlay.name}_{number}"
        caption = (
            f"{', '.join(page)}: {_means(walkers)}.{overlay.caption}{_people(runs)}{_left_out(runs, page, others)}"
        )
        yield Drawing(name, f"{overlay.title} over the gait cycle{of}", caption, _figure(page, runs))


def _figure(names: Sequence[str], runs: Sequence[tuple[str, Mapping[str, Curve]]]) -> Figure:
    figure, axes = panels(len(names), 2, height=1.6, share=True)
    for row, name in enumerate(names):
        axes[2 * row + 1].sharey(axes[2 * row])
        for column, side in enumerate(SIDES):
            _panel(axes[2 * row + column], side, [(label, curves.get(name)) for label, curves in runs])
        first = next(curves[name] for _, curves in runs if name in curves)
        axes[2 * row].set_ylabel(first.axis)
    for panel, leg in zip(axes[:2], SIDES.values(), strict=True):
        panel.set_title(leg, loc="left", fontsize=FONT)
    for panel in axes[-2:]:
        panel.set_xlabel(labelled("gait cycle", "%"))
    _legend(figure, axes)
    return figure


def _panel(panel: Axes, side: str, curves: Sequence[tuple[str, Curve | None]]) -> None:
    """One side of one quantity: people, then a line for each run. The n-th run has the n-th style everywhere."""
    norms = [curve.norm for _, curve in curves if curve and curve.norm]
    if norms:
        first = next(curve for _, curve in curves if curve)
        draw_people(panel, norms[0], first.factor)
    for number, (label, curve) in enumerate(curves):
        if curve is not None and side in curve.cycles:
            mean = curve.factor * curve.cycles[side].mean
            panel.plot(PERCENT, mean, **_look(number), linewidth=1.2, label=label)
    panel.set_xlim(0, 100)


def _look(number: int) -> dict[str, Any]:
    """Colour and line style of the n-th run, from 0. The colour of people is not used."""
    return {"color": _COLOURS[number % len(_COLOURS)], "linestyle": LINES[number // len(_COLOURS) % len(LINES)]}


def _legend(figure: Figure, axes: Sequence[Axes]) -> None:
    """One legend for all panels, below them."""
    found = {label: handle for panel in axes for handle, label in zip(*panel.get_legend_handles_labels(), strict=True)}
    columns = 1 if max(map(len, found), default=0) > 36 else 2
    figure.legend(
        list(found.values()), list(found), loc="outside lower center", ncols=columns, frameon=False, fontsize=FONT - 1
    )


def _means(walkers: Sequence[tuple[Replay, Legs]]) -> str:
    counts = [f"{replay.label} {np.sum([len(leg.strides) for leg in legs])}" for replay, legs in walkers]
    return f"mean over the strides of each leg, from touchdown to touchdown (strides of both legs: {', '.join(counts)})"


def _people(runs: Sequence[tuple[str, Mapping[str, Curve]]]) -> str:
    norms = [curve.norm for _, curves in runs for curve in curves.values() if curve.norm]
    sources = ", ".join(dict.fromkeys(norm.recorded_by for norm in norms if norm.recorded_by))
    return f" Green: healthy people{f' ({sources})' if sources else ''}." if norms else ""


def _left_out(runs: Sequence[tuple[str, Mapping[str, Curve]]], names: Sequence[str], others: Sequence[str]) -> str:
    lacking = [f" {label} has no {name}." for label, curves in runs for name in names if name not in curves]
    walking = [f" {label} does not take two strides with each leg." for label in others]
    return "".join([*lacking, *walking])
