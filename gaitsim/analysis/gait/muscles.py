"""Muscles of a walker over the gait cycle: activations and metabolic power."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import FONT, above, labelled, panels
from gaitsim.analysis.gait.comparison import runs
from gaitsim.analysis.gait.keypoints import ON, ON_BY, draw_on
from gaitsim.analysis.gait.legs import SIDES, Leg, mass, side_of, unsided
from gaitsim.analysis.gait.panels import BAND, PEOPLE, draw_cycle, name_lines, strides_text
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay

Legs = Sequence[Leg]


def sided_muscles(replay: Replay) -> dict[str, dict[str, str]]:
    """The muscles of both sides: name within the side -> side -> address."""
    found: dict[str, dict[str, str]] = {}
    for part in replay.model.parts:
        if part.type.kind == "muscle" and side_of(part.address):
            found.setdefault(unsided(part.address), {})[side_of(part.address)] = part.address
    return {name: pair for name, pair in found.items() if pair.keys() == SIDES.keys()}


def activation_figures(replay: Replay, legs: Legs) -> list[Drawing]:
    """The activation of each muscle that both legs have."""
    names = sided_muscles(replay)
    if not names:
        return []
    figure, axes = panels((len(names) + 1) // 2, 2, height=1.3, share=True)
    known = set() if runs(replay) else names.keys() & ON.keys()
    for panel, name in zip(axes, names, strict=False):
        for leg in legs:
            draw_cycle(panel, leg, leg.over_cycle(replay.trajectory[f"{names[name][leg.side]}.activation"]))
        if name in known:
            draw_on(panel, name)
        panel.set_title(name.replace("_", " "), loc="left", fontsize=FONT)
        panel.set_ylim(0, 1.02)
    for unused in axes[len(names) :]:
        unused.set_axis_off()
    for panel in axes[: len(names)][-2:]:
        panel.tick_params(labelbottom=True)
    for panel in axes[::2]:
        panel.set_ylabel(labelled("activation", "1"))
    figure.supxlabel(labelled("gait cycle", "%"), fontsize=FONT)
    if known:
        axes[0].plot([], [], color=PEOPLE, linewidth=4, label="on in people")
    name_lines(figure, axes[0])
    on = f" Bars above: where people's muscle is above half of its range ({ON_BY})." if known else ""
    caption = f"Activation of each muscle: {strides_text(legs)}. {BAND} Dotted: take-off.{on}"
    return [Drawing("gait_activations", "Muscle activations over the gait cycle", caption, figure)]


def metabolic_power(replay: Replay, leg: Leg) -> Floats | None:
    """The metabolic power of all muscles of a leg divided by body mass, in W/kg; None if no muscle reports it."""
    models = [p.address for p in replay.model.parts if p.type.kind == "metabolics" and side_of(p.address) == leg.side]
    if not models or leg.weight <= 0:
        return None
    total = np.sum([replay.trajectory[f"{address}.power"] for address in models], axis=0)
    return np.asarray(total / mass(replay, leg), dtype=np.float64)


def metabolic_figures(replay: Replay, legs: Legs) -> list[Drawing]:
    """The metabolic power of each leg's muscles."""
    powers = {leg.side: power for leg in legs if (power := metabolic_power(replay, leg)) is not None}
    if not powers:
        return []
    figure, (panel,) = panels(height=2.2)
    summaries = []
    for leg in legs:
        if leg.side in powers:
            draw_cycle(panel, leg, leg.over_cycle(powers[leg.side]))
            summaries.append(f"{leg.name} {np.mean(leg.share(powers[leg.side])):.3g} W/kg")
    panel.set_ylabel(labelled("metabolic power", "W/kg"))
    panel.set_xlabel(labelled("gait cycle", "%"))
    above(panel)
    caption = (
        f"Metabolic power of all muscles of each leg over body mass: {strides_text(legs)}. {BAND} Dotted: take-off. "
        f"In the mean {' and '.join(summaries)}; the body's power at rest is not in it."
    )
    return [Drawing("gait_metabolics", "Metabolic power over the gait cycle", caption, figure)]
