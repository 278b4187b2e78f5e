"""Balance to the side of a walker in space: footprints, step width, and the lateral margin of stability."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import GREY, PALETTE, above, labelled, panels
from gaitsim.analysis.gait.footsteps import center_of, landing_contact, landings, on_level_ground
from gaitsim.analysis.gait.legs import Leg, unsided
from gaitsim.analysis.gait.panels import BAND, LINE, draw_cycle, strides_text
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LEFT = {"l": 1.0, "r": -1.0}  # the outer side of a leg


@dataclass(frozen=True)
class Print:
    """Where a foot was set down: side, time in s, and place along and to the left of the way of the walker, in m."""

    side: str
    at: float
    along: float
    aside: float


@dataclass(frozen=True)
class Way:
    """The straight way of a walker over the ground: a place on it in m, and its heading in rad to the left."""

    forward: float
    left: float
    heading: float

    def seen(self, forward: Floats, left: Floats) -> tuple[Floats, Floats]:
        """Places along the way and to the left of it."""
        x, y = np.asarray(forward) - self.forward, np.asarray(left) - self.left
        cosine, sine = np.cos(self.heading), np.sin(self.heading)
        return x * cosine + y * sine, y * cosine - x * sine

    def turned(self, forward: Floats, left: Floats) -> Floats:
        """The part of a velocity to the left of the way."""
        return np.asarray(left * np.cos(self.heading) - forward * np.sin(self.heading), dtype=np.float64)


def lateral_figures(replay: Replay, legs: Sequence[Leg]) -> list[Drawing]:
    """Footprints from above, step width, and margin to the side; none for a model in the plane."""
    sensor = center_of(replay.model)
    places = [f"{contact}.side_position" for leg in legs for contact in leg.contacts]
    if sensor is None or not set(places) <= set(replay.trajectory.signals):
        return []
    way = way_of(replay, sensor, legs)
    prints = footprints(replay, way, legs)
    margins = lateral_margins(replay, sensor, way, legs) if on_level_ground(replay.model) else None
    figure, axes = panels(2 if margins is None else 3, 1, height=1.8)
    _draw_map(axes[0], replay, sensor, way, prints)
    widths = step_widths(prints)
    for leg in legs:
        mine = [(each.at, 100 * width) for each, width in widths if each.side == leg.side]
        axes[1].plot(*np.array(mine).reshape(-1, 2).T, linewidth=0.8, **_dots(leg.side), label=leg.name)
    axes[1].set_ylabel(labelled("step width", "cm"))
    axes[1].set_xlabel(labelled("time of touchdown", "s"))
    above(axes[1])
    margins_text = ""
    if margins is not None:
        margins_text = _draw_margins(axes[2], legs, margins)
    spread = np.array([100 * width for _, width in widths])
    mean = f"{np.mean(spread):.3g} ± {np.std(spread):.2g} cm (mean ± standard deviation)" if len(spread) else "–"
    caption = (
        "Top: footprints seen from above, along the mean way of the walker, with the paths of its center of mass and "
        "of its extrapolated center of mass, x + v sqrt(l / g) (Hof and others 2005). The step width is the distance "
        "of a print from the line between the prints of the other foot before and after it (Huxham and others 2006): "
        f"{mean}.{margins_text}"
    )
    return [Drawing("gait_lateral", "Footprints, step width and margin to the side", caption, figure)]


def way_of(replay: Replay, sensor: str, legs: Sequence[Leg]) -> Way:
    """The line through the center of mass at the first and at the last touchdown."""
    touchdowns = [at for leg in legs for at in leg.touchdowns]
    ends = (min(touchdowns), max(touchdowns))
    x, y = (np.interp(ends, replay.times, replay.trajectory[f"{sensor}.{name}"]) for name in ("forward", "left"))
    return Way(float(x[0]), float(y[0]), float(np.arctan2(y[1] - y[0], x[1] - x[0])))


def footprints(replay: Replay, way: Way, legs: Sequence[Leg]) -> list[Print]:
    """The prints of both feet in order: where that part of the foot is that landed first at the first touchdown."""
    landed = landings(legs)
    part = unsided(landing_contact(replay, landed[0][1], landed[0][0]))
    found = []
    for at, leg in landed:
        contact = next((c for c in leg.contacts if unsided(c) == part), leg.contacts[0])
        places = (replay.trajectory[f"{contact}.{name}"] for name in ("position", "side_position"))
        (along,), (aside,) = way.seen(*(np.interp([at], replay.times, place) for place in places))
        found.append(Print(leg.side, at, float(along), float(aside)))
    return found


def step_widths(prints: Sequence[Print]) -> list[tuple[Print, float]]:
    """The width in m of each step between two of the other foot; negative where the legs cross."""
    found = []
    for before, here, after in zip(prints, prints[1:], prints[2:], strict=False):
        if before.side == after.side != here.side:
            x, y = after.along - before.along, after.aside - before.aside
            cross = x * (here.aside - before.aside) - y * (here.along - before.along)
            found.append((here, _LEFT[here.side] * cross / float(np.hypot(x, y))))
    return found


def lateral_margins(replay: Replay, sensor: str, way: Way, legs: Sequence[Leg]) -> dict[str, Floats]:
    """By side, how far in m the extrapolated center of mass is inside of the outermost contact of a foot that stands;
    nan while it does not.
    """
    signals = replay.trajectory
    time = np.sqrt(np.mean(signals[f"{sensor}.height"]) / replay.model.simulate.gravity)
    _, center = way.seen(signals[f"{sensor}.forward"], signals[f"{sensor}.left"])
    rate = way.turned(signals[f"{sensor}.forward_velocity"], signals[f"{sensor}.left_velocity"])
    reached = center + time * rate
    found = {}
    for leg in legs:
        outwards = _LEFT[leg.side]
        places = [way.seen(signals[f"{c}.position"], signals[f"{c}.side_position"])[1] for c in leg.contacts]
        border = np.max([outwards * place for place in places], axis=0)
        found[leg.side] = np.where(leg.standing > 0, border - outwards * reached, np.nan)
    return found


def least_margins(leg: Leg, other: Leg, margin: Floats) -> Floats:
    """The least margin in m of each stance, while the foot stands alone."""
    alone = np.where(other.standing > 0, np.inf, margin)
    least = np.array([np.min(alone[stance]) for stance in leg.stances], dtype=np.float64)
    return np.asarray(least[np.isfinite(least)], dtype=np.float64)


def _draw_map(panel: Axes, replay: Replay, sensor: str, way: Way, prints: Sequence[Print]) -> None:
    inside = (replay.times >= prints[0].at) & (replay.times <= prints[-1].at)
    signals = replay.trajectory
    x, y = way.seen(signals[f"{sensor}.forward"][inside], signals[f"{sensor}.left"][inside])
    time = np.sqrt(np.mean(signals[f"{sensor}.height"]) / replay.model.simulate.gravity)
    rates = (signals[f"{sensor}.forward_velocity"][inside], signals[f"{sensor}.left_velocity"][inside])
    ahead = time * (rates[0] * np.cos(way.heading) + rates[1] * np.sin(way.heading))
    panel.plot(x, 100 * y, color=GREY, linewidth=1, label="center of mass")
    panel.plot(x + ahead, 100 * (y + time * way.turned(*rates)), color=PALETTE[2], linewidth=0.8, label="extrapolated")
    for side, name in (("l", "left foot"), ("r", "right foot")):
        mine = [each for each in prints if each.side == side]
        panel.plot([p.along for p in mine], [100 * p.aside for p in mine], linestyle="none", **_dots(side), label=name)
    panel.set_xlabel(labelled("along the way", "m"))
    panel.set_ylabel(labelled("to the left", "cm"))
    above(panel)


def _draw_margins(panel: Axes, legs: Sequence[Leg], margins: dict[str, Floats]) -> str:
    """Draw the margin of each leg over its stance.

    Returns:
        The caption.
    """
    summaries = []
    for leg, other in zip(legs, reversed(legs), strict=True):
        draw_cycle(panel, leg, leg.over_cycle(100 * margins[leg.side]))
        least = 100 * least_margins(leg, other, margins[leg.side])
        if len(least):
            summaries.append(f"{leg.name} {np.mean(least):.3g} cm, at worst {np.min(least):.3g} cm")
    panel.axhline(0, color=GREY, linewidth=0.8)
    panel.set_ylabel(labelled("margin to the side", "cm"))
    panel.set_xlabel(labelled("gait cycle", "%"))
    above(panel)
    return (
        " Margin to the side: by how far the extrapolated center of mass is inside of the outermost contact of the "
        f"standing foot, {strides_text(legs)}. {BAND} Dotted: take-off. Least while it stands alone: "
        f"{'; '.join(summaries)}. Below 0 the walker falls to that side unless its legs cross."
    )


def _dots(side: str) -> dict[str, Any]:
    return {"color": LINE[side]["color"], "marker": "o" if side == "l" else "s", "markersize": 4}
