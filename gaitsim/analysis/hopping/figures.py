"""Figures of hopping: apexes, the return map with its fixed point, and the ground force."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import GREY, PALETTE, labelled, legend, panels, whole_numbers
from gaitsim.analysis.gait.legs import two_legs
from gaitsim.analysis.replays.cycles import Floats, arriving, shade_stance, shown_part, thinned
from gaitsim.analysis.replays.reference import return_map_of
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.signals.return_map import FixedPoint, fixed_between, fixed_point
from gaitsim.model import Free, Model, Part
from gaitsim.simulation.run import Simulator
from gaitsim.units import parse_unit

_STARTS = 25
_HIGHEST = 2.2  # times the highest apex above touchdown


@dataclass(frozen=True)
class Hops:
    """The hops that a measure observes: heights in m above its reference, and 1 in the air.

    Attributes:
        coordinate: The joint coordinate of the height, if `initial:` can set it.
    """

    measure: str
    signal: str
    heights: Floats
    airborne: Floats
    reference: float
    least: float
    coordinate: str | None

    @property
    def apexes(self) -> list[int]:
        """The instants of the apexes: the highest point of each flight, including a start in the air.

        A flight that the end of the run cuts before its highest point has none. Neither has a hop below the least
        height of the measure.
        """
        flying = self.airborne > 0.5
        if not len(flying):
            return []
        edges = [0, *(np.flatnonzero(flying[1:] != flying[:-1]) + 1).tolist(), len(flying)]
        found = []
        for begin, end in pairwise(edges):
            if not flying[begin]:
                continue
            at = begin + int(np.argmax(self.heights[begin:end]))
            cut = end == len(flying) and at == end - 1
            grounded = at == begin and begin > 0
            fall = self.heights[at] - self.heights[min(end, len(flying) - 1)]
            if not (cut or grounded) and (fall >= self.least or end == len(flying)):
                found.append(at)
        return found

    @property
    def touchdown(self) -> float | None:
        """The height at the first touchdown after a flight; None if there is none."""
        landed = np.flatnonzero((self.airborne[:-1] > 0.5) & (self.airborne[1:] <= 0.5)) + 1
        return float(self.heights[landed[0]]) if landed.size else None


def hops_of(replay: Replay) -> Hops | None:
    """The hops of a run, by the first measure that observes a height and a contact; None without such a measure."""
    part = next((part for part in replay.model.parts if part.measure and _watches_hops(part)), None)
    if part is None:
        return None
    own, values = part.address, replay.model.values()
    airborne = (
        arriving(replay, f"{own}.airborne")
        if "airborne" in part.type.inputs
        else 1.0 - arriving(replay, f"{own}.contact")
    )
    reference = values[part.numbers["reference"]] if "reference" in part.numbers else 0.0
    least = values[part.numbers["least_height"]] if "least_height" in part.numbers else 0.0
    senders = [c for c in replay.model.connections if c.target == f"{own}.height"]
    signal = senders[0].sender if len(senders) == 1 and senders[0].delay is None else None
    return Hops(
        own,
        signal or f"{own}.height",
        arriving(replay, f"{own}.height") - reference,
        airborne,
        reference,
        least,
        signal if signal in replay.model.initial else None,
    )


def _watches_hops(part: Part) -> bool:
    return "height" in part.type.inputs and not {"airborne", "contact"}.isdisjoint(part.type.inputs)


@dataclass(frozen=True)
class ApexPairs:
    """Pairs of consecutive apex heights in m above the reference; nan where there was no second apex."""

    before: Floats
    after: Floats

    @property
    def fixed_points(self) -> list[FixedPoint]:
        """The fixed points of the map and its slopes there, between neighbouring starts."""
        known = np.isfinite(self.after)
        x, above = self.before[known], (self.after - self.before)[known]
        return [fixed_between(x, above, int(i)) for i in np.flatnonzero(above[:-1] * above[1:] < 0)]


def dropped(replay: Replay, count: int = _STARTS) -> ApexPairs | None:
    """The return map from many starts: the model is dropped in the same posture from different heights.

    Returns:
        The map; None if `initial:` cannot set the height, or if the run never touched down.
    """
    hops = hops_of(replay)
    if hops is None or hops.coordinate is None or hops.touchdown is None or not hops.apexes:
        return None
    ground, places = hops.touchdown, hops.apexes
    span = _HIGHEST * (max(hops.heights[at] for at in places) - ground)
    if span <= 0:
        return None
    starts = ground + span * np.linspace(1 / count, 1, count)
    model = _with_free_start(replay.model, hops.coordinate)
    # Two apexes of the run took this long; from other heights it takes somewhat longer.
    least = 2.0 * float(replay.times[places[min(1, len(places) - 1)]]) + 1.0
    model = replace(model, simulate=replace(model.simulate, duration=min(least, model.simulate.duration)))
    simulator = Simulator(model)
    after = np.full(count, np.nan)
    for i, height in enumerate(starts):
        outcome = simulator.run([*replay.values, float(height + hops.reference)], recorded=True)
        seen = hops_of(Replay(replay.label, replay.path, model, outcome)) if outcome.trajectory else None
        if seen is not None and len(seen.apexes) > 1:
            after[i] = seen.heights[seen.apexes[1]]
    return ApexPairs(starts, after)


def _with_free_start(model: Model, coordinate: str) -> Model:
    """The model with an additional free number: the initial value of a coordinate."""
    place = model.initial[coordinate]
    number = replace(model.numbers[place], free=len(model.free), expression=None, fraction_of=None)
    name, start = f"initial.{coordinate}", model.values()[place]
    free = Free(name, parse_unit("m"), -np.inf, np.inf, start, 1.0, "", (number.address,))
    numbers = (*model.numbers[:place], number, *model.numbers[place + 1 :])
    return replace(model, numbers=numbers, free=(*model.free, free))


def hopping_figures(replay: Replay) -> list[Drawing]:
    """The return map, the apexes, and the ground force. Walkers have the latter over the gait cycle instead."""
    if len(replay.times) < 2:
        return []
    hops = hops_of(replay)
    if hops is None:
        return [] if two_legs(replay) else _ground_force(replay)
    apexes = [_apexes(hops)] if hops.apexes else []
    return [*_return_map(replay, hops), *apexes, *_ground_force(replay)]


def _hop_count(hops: Hops) -> str:
    above = f" above {hops.reference:g} m" if hops.reference else ""
    return f"{hops.signal}{above}"


def _return_map(replay: Replay, hops: Hops) -> list[Drawing]:
    own, starts = hops.heights[hops.apexes], dropped(replay)
    if starts is not None and not np.isfinite(starts.after).any():
        starts = None
    if starts is None and len(own) < 2:
        return []
    figure, (axes,) = panels(1, 1, height=5.0)
    sentences = [f"Each apex of {_hop_count(hops)} against the one before; on the diagonal a hop repeats itself."]
    if starts is not None:
        axes.plot(starts.before, starts.after, "o-", color=PALETTE[0], markersize=3.5, label="one hop after each start")
        sentences.append(_of_starts(starts))
    settled = fixed_point(own)
    points = (starts.fixed_points if starts else []) or ([settled] if settled else [])
    for k, point in enumerate(points):
        stable = point.slope is None or abs(point.slope) < 1
        kind = "stable" if stable else "unstable"
        mark: dict[str, Any] = {
            "marker": "*" if stable else "X",
            "markersize": 12,
            "color": PALETTE[1],
            "linestyle": "none",
        }
        axes.plot([point.value], [point.value], **mark, zorder=4, label=f"{kind} fixed point" if k < 2 else None)
        slope = "" if point.slope is None else f", where the slope is {point.slope:.2g}"
        sentences.append(f"The {kind} fixed point is at {point.value:.4g} m{slope}.")
    if len(own) > 1:
        axes.plot(np.repeat(own, 2)[1:-1], np.repeat(own, 2)[2:], color=GREY, linewidth=0.8)
        axes.plot(own[:-1], own[1:], "o", color=GREY, markersize=3, label="hops of this run")
        sentences.append(f"Grey: the {len(own)} apexes of this run, in steps from one to the next.")
    published = return_map_of(replay)
    if published is not None:
        axes.plot(*published.points, "s", color=PALETTE[2], markerfacecolor="none", label="reference")
        sentences.append(f"Squares: {published.source}.")
    low, high = _square(axes.dataLim.x0, axes.dataLim.x1, axes.dataLim.y0, axes.dataLim.y1)
    axes.plot([low, high], [low, high], color="black", linewidth=0.8, zorder=1)
    axes.set(xlim=(low, high), ylim=(low, high), aspect="equal")
    axes.set_xlabel(labelled("apex height", "m"))
    axes.set_ylabel(labelled("next apex height", "m"))
    legend(axes)
    return [Drawing("return_map", "Return map of apex heights", " ".join(sentences), figure)]


def _of_starts(starts: ApexPairs) -> str:
    lost = starts.before[np.isnan(starts.after)]
    sentence = f"Dots: the model in its initial posture, dropped at rest from {len(starts.before)} heights."
    if not lost.size:
        return sentence
    return f"{sentence} {lost.size} of them, from {lost.min():.4g} to {lost.max():.4g} m, had no second apex."


def _square(*ends: float) -> tuple[float, float]:
    """Give both axes one range."""
    low, high = min(ends), max(ends)
    margin = 0.05 * (high - low) or 0.05
    return low - margin, high + margin


def _apexes(hops: Hops) -> Drawing:
    figure, (axes,) = panels(1, 1, height=2.4)
    heights = hops.heights[hops.apexes]
    axes.plot(range(len(heights)), heights, "o-", color=PALETTE[0], markersize=4)
    whole_numbers(axes)
    axes.set_xlabel(labelled("hop", "1"))
    axes.set_ylabel(labelled("apex height", "m"))
    extent = np.ptp(heights)
    if extent < 1e-3:  # rounding errors are not worth a magnified axis
        axes.set_ylim(heights.mean() - 0.01, heights.mean() + 0.01)
    last = heights[-3:]
    caption = (
        f"Height of each apex, {_hop_count(hops)}; hop 0 is the start. The last {len(last)} are at "
        f"{last.mean():.5g} m on average and differ by {np.ptp(last):.2g} m."
    )
    return Drawing("apex_heights", "Apex heights", caption, figure)


def _ground_force(replay: Replay) -> list[Drawing]:
    forces = [
        f"{part.address}.force"
        for part in replay.model.parts
        if part.type.kind == "contact" or {"in_stance", "force"} <= part.type.outputs.keys()
    ]
    part, period = shown_part(replay)
    if len(part.times) < 2 or not forces:
        return []
    figure, (axes,) = panels(1, 1, height=2.4)
    for signal in forces:
        axes.plot(*thinned(part.times, part.trajectory[signal]), label=signal.removesuffix(".force"))
    shaded = shade_stance(axes, part)
    axes.margins(x=0)
    axes.set_xlabel(labelled("time", "s"))
    axes.set_ylabel(labelled("vertical ground force", "N"))
    if len(forces) > 1:
        legend(axes)
    peaks = ", ".join(f"{s.removesuffix('.force')} {part.trajectory[s].max():.4g} N" for s in forces)
    caption = f"Force of the ground, upwards, over {period}. Largest: {peaks}.{' Grey: stance.' if shaded else ''}"
    return [Drawing("ground_force", "Ground reaction force", caption, figure)]
