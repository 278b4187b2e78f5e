"""Figures of one run of any model: joint coordinates and signals of controllers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import above, labelled, limit_vertical, panels, quantity
from gaitsim.analysis.gait.legs import on_side, side_of
from gaitsim.analysis.replays.cycles import shade_stance, shown_part, thinned
from gaitsim.analysis.replays.replay import Replay
from gaitsim.units import parse_unit

_LINES, _PANELS = 4, 4  # in a panel, in a figure
_MANY = 32  # signals of controllers; of more, --plot draws those that are asked for
_SHOWN = {"rad": ("deg", np.degrees(1.0)), "rad/s": ("deg/s", np.degrees(1.0))}

Signals = Sequence[tuple[str, str]]  # address, and unit of what was recorded


def motion_figures(replay: Replay) -> list[Drawing]:
    """Joint coordinates and signals of controllers, over the last cycles or the whole run."""
    if len(replay.times) < 2:
        return []
    coordinates, sent = _outputs(replay, "joint", ("angle", "position")), _outputs(replay, "controller", ())
    return [
        *_figures(replay, "joints", "Coordinates of the joints", coordinates),
        *(_figures(replay, "controllers", "Signals of the controllers", sent) if len(sent) <= _MANY else []),
    ]


def _outputs(replay: Replay, kind: str, names: Sequence[str]) -> Signals:
    """The outputs of parts of a kind, with these names or all."""
    return [
        (f"{part.address}.{name}", parse_unit(output.unit).si)
        for part in replay.model.parts
        if part.type.kind == kind
        for name, output in part.type.outputs.items()
        if not names or name in names
    ]


def _figures(replay: Replay, name: str, title: str, signals: Signals) -> list[Drawing]:
    contact = next((p.address for p in replay.model.parts if p.type.kind == "contact" and side_of(p.address)), "")
    leg = on_side(contact, "r")
    part, period = shown_part(replay, address=leg)
    if len(part.times) < 2:
        part, period = replay, "the whole run"
    groups = list(_panels(signals))
    pages = [groups[i : i + _PANELS] for i in range(0, len(groups), _PANELS)]
    found = []
    for number, page in enumerate(pages, start=1):
        figure, axes = panels(len(page), 1, height=1.9, share=True)
        shaded = False
        for panel, group in zip(axes, page, strict=True):
            unit, factor = _SHOWN.get(group[0][1], (group[0][1], 1.0))
            for address, _ in group:
                panel.plot(*thinned(part.times, factor * part.trajectory[address]), label=address)
            panel.set_ylabel(labelled(quantity(group[0][1]), unit))
            shaded = shade_stance(panel, part, group[0][0] if side_of(group[0][0]) else leg) or shaded
            limit_vertical(panel)
            above(panel)
            panel.margins(x=0)
        axes[-1].set_xlabel(labelled("time", "s"))
        of = f" ({number} of {len(pages)})" if len(pages) > 1 else ""
        listed = ", ".join(address for group in page for address, _ in group)
        caption = f"{listed} over {period}.{' Grey: stance.' if shaded else ''}"
        found.append(Drawing(f"{name}_{number}" if len(pages) > 1 else name, title + of, caption, figure))
    return found


def _panels(signals: Signals) -> Iterator[Signals]:
    """Signals of one unit and one side together, a few in each panel."""
    for key in dict.fromkeys((unit, side_of(address)) for address, unit in signals):
        same = [signal for signal in signals if (signal[1], side_of(signal[0])) == key]
        yield from (same[i : i + _LINES] for i in range(0, len(same), _LINES))
