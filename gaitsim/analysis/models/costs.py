"""The figure of a profile: the largest costs as bars."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import FONT, GREY, PALETTE, panels

if TYPE_CHECKING:
    from gaitsim.simulation.profile import Cost, Profile

_BARS = 25
_INCHES = 0.19  # a bar


def cost_figure(costs: Sequence[Cost], profile: Profile, name: str) -> Drawing:
    """The largest costs of a step, one bar each, coloured by the kind of component; those of MuJoCo are grey."""
    largest = costs[:_BARS]
    figure, (axes,) = panels(height=0.6 + _INCHES * len(largest))
    kinds = list(dict.fromkeys(kind for kind in map(_kind, largest) if kind))
    colours = {kind: PALETTE[i % len(PALETTE)] for i, kind in enumerate(kinds)} | {"MuJoCo": GREY}
    labelled: set[str] = set()
    for place, cost in enumerate(largest):
        kind = _kind(cost)
        label = None if kind in labelled else kind or "loop"
        labelled.add(kind)
        axes.barh(place, 1e9 * cost.seconds, color=colours.get(kind, "#BBBBBB"), label=label)
    axes.set_yticks(range(len(largest)), [cost.name for cost in largest], fontsize=FONT - 2)
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("time a step (ns)")
    axes.legend(fontsize=FONT - 1, loc="lower right")
    rest = sum(cost.seconds for cost in costs[_BARS:])
    others = f" The other {len(costs) - _BARS} take {1e9 * rest:,.0f} ns." if len(costs) > _BARS else ""
    caption = (
        f"What takes how long in one step of {name}, which takes {1e9 * profile.step:,.0f} ns as a whole.{others} "
        f"A stopwatch in the native code measured it; with it a step takes {profile.slower:.2f} times as long."
    )
    return Drawing(f"{name}.profile", f"Run time of {name}", caption, figure)


def _kind(cost: Cost) -> str:
    return cost.use.partition("/")[0]
