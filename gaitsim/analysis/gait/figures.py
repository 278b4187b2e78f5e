"""Figures of a walker on two legs: curves over the gait cycle beside people, steps, and symmetry."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import FONT, GREY, above, labelled, panels, quantity
from gaitsim.analysis.gait.comparison import (
    ComparedQuantity,
    ComparedSignal,
    compared_signals,
    matched_moments,
    matched_signals,
    runs,
)
from gaitsim.analysis.gait.footsteps import double_support, lacks_center, margin, steps, symmetry
from gaitsim.analysis.gait.frontal import frontal_figures
from gaitsim.analysis.gait.joint_moments import joint_power, joint_work
from gaitsim.analysis.gait.keypoints import FORWARDS, PEAKS_BY, POWERS, VERTICAL, draw_peaks, name_peaks
from gaitsim.analysis.gait.lateral import lateral_figures
from gaitsim.analysis.gait.legs import SIDES, Leg, has_two_legs, mass, on_side, two_legs
from gaitsim.analysis.gait.muscles import activation_figures, metabolic_figures, sided_muscles
from gaitsim.analysis.gait.panels import BAND, LINE, draw_cycle, draw_people, name_lines, strides_text
from gaitsim.analysis.gait.pressure import pressure_figures
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay
from gaitsim.units import parse_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Legs = Sequence[Leg]
_IN_TABLE = "How they compare in numbers is in the table Compared with people."


def gait_figures(replay: Replay) -> list[Drawing]:
    """Angles, ground forces, moments and powers, activations, steps, margin of stability, and symmetry."""
    legs = two_legs(replay)
    if legs is None:
        return []
    return [
        *_angles(replay, legs),
        _forces(replay, legs),
        *frontal_figures(replay, legs),
        *lateral_figures(replay, legs),
        *pressure_figures(replay, legs),
        *_moments(replay, legs),
        *activation_figures(replay, legs),
        *metabolic_figures(replay, legs),
        _steps(replay, legs),
        *_margin(replay, legs),
        _symmetry(replay, legs),
    ]


def lacking_gait(replay: Replay) -> list[str]:
    """The figures that a walker lacks, with the reasons, for the reader."""
    if not has_two_legs(replay.model):
        return []
    if two_legs(replay) is None:
        return [f"{replay.label} takes fewer than two strides with each leg, so nothing is drawn over the gait cycle."]
    found = []
    if not compared_signals(replay):
        move = "add a measure/gait_curve for each joint"
        found.append(f"{replay.label} does not say which angles people have too, so none is compared; {move}.")
    if lacks_center(replay.model):
        move = "add center: {use: sensor/center_of_mass} to its parts"
        found.append(f"{replay.label} does not tell its center of mass, so no margin to falling is drawn; {move}.")
    return found


def _draw_matched(panel: Axes, legs: Legs, matched: ComparedQuantity, unit: str) -> None:
    factor = 1 / parse_unit(unit).factor
    draw_people(panel, matched.norm, factor)
    for leg in legs:
        if leg.side in matched.cycles:
            draw_cycle(panel, leg, matched.cycles[leg.side], factor)


def _people_words(matched: Sequence[ComparedQuantity]) -> str:
    bands = any(one.norm.deviation is not None for one in matched)
    sources = ", ".join(dict.fromkeys(one.norm.recorded_by for one in matched if one.norm.recorded_by))
    band = " with one standard deviation over subjects" if bands else ""
    return f"Green: healthy people's mean{band}{f' ({sources})' if sources else ''}."


def _angles(replay: Replay, legs: Legs) -> list[Drawing]:
    matched = matched_signals(replay, legs)
    if not matched:
        return []
    figure, axes = panels(len(matched), 1, height=1.9, share=True)
    for panel, one in zip(axes, matched, strict=True):
        _draw_matched(panel, legs, one, one.norm.unit)
        panel.set_ylabel(labelled(one.name, one.norm.unit))
    above(axes[0])
    axes[-1].set_xlabel(labelled("gait cycle", "%"))
    turning = all(quantity(one.norm.unit) == "angle" for one in matched)
    title = "Joint angles over the gait cycle" if turning else "Signals over the gait cycle"
    caption = (
        f"{', '.join(one.name for one in matched)}: {strides_text(legs)}. {BAND} Dotted: take-off. "
        f"{_people_words(matched)} Zeros of hip and ankle differ by 10 to 20 deg between laboratories. {_IN_TABLE}"
    )
    return [Drawing("gait_angles", title, caption, figure)]


def _forces(replay: Replay, legs: Legs) -> Drawing:
    figure, (vertical, forward) = panels(2, 1, height=1.9, share=True)
    for leg in legs:
        load, shear = leg.over_cycle(leg.load), leg.over_cycle(leg.shear)
        draw_cycle(vertical, leg, load)
        draw_cycle(forward, leg, shear)
    peaks = ""
    if not runs(replay):
        draw_peaks(vertical, VERTICAL)
        draw_peaks(forward, FORWARDS)
        name_peaks(vertical)
        peaks = f" Green: peaks of healthy people at natural speed, level ({PEAKS_BY})."
    vertical.axhline(1, color=GREY, linewidth=0.8, linestyle=":")
    vertical.set_ylabel("vertical (body weights)")
    forward.set_ylabel("forwards (body weights)")
    forward.set_xlabel(labelled("gait cycle", "%"))
    above(vertical)
    caption = (
        "Force of the ground on each foot in body weights, along the ground's normal and forwards along the ground: "
        f"{strides_text(legs)}. {BAND} Dotted: take-off.{peaks} The table Gait has the peaks."
    )
    return Drawing("gait_forces", "Ground reaction forces over the gait cycle", caption, figure)


def _moments(replay: Replay, legs: Legs) -> list[Drawing]:
    matched = matched_moments(replay, legs)
    joints = {one.name.split()[0]: one for one in compared_signals(replay)}
    if not matched:
        return []
    figure, axes = panels(len(matched), 2, height=1.8, share=True)
    summaries = []
    for row, one in enumerate(matched):
        moment, power = axes[2 * row], axes[2 * row + 1]
        _draw_matched(moment, legs, one, "N m/kg")
        moment.set_title(one.name.removesuffix(" moment"), loc="left", fontsize=FONT)
        moment.set_ylabel(labelled("moment", "N m/kg"))
        works = _draw_power(power, replay, legs, joints[one.name.split()[0]])
        summaries.append(f"{one.name.split()[0]} {works}")
    name_lines(figure, axes[0])
    for panel in axes[-2:]:
        panel.set_xlabel(labelled("gait cycle", "%"))
    caption = (
        f"Net joint moments (of muscles, stops and damping) and their powers over body mass: {strides_text(legs)}. "
        f"Extension and plantarflexion are positive; power is positive where a joint gives work. {BAND} "
        f"Dotted: take-off. {_people_words(matched)} Dots: peaks of their powers ({PEAKS_BY}). Work a stride: "
        f"{'; '.join(summaries)}. {_IN_TABLE}"
    )
    return [Drawing("gait_moments", "Joint moments and powers over the gait cycle", caption, figure)]


def _draw_power(panel: Axes, replay: Replay, legs: Legs, joint: ComparedSignal) -> str:
    """Draw the power of a joint in W/kg.

    Returns:
        The positive and negative work of a stride, in words.
    """
    summaries = []
    for leg in legs:
        own = on_side(joint.signal, leg.side).rpartition(".")[0]
        power, works = joint_power(replay, own), joint_work(replay, leg, own)
        if power is None or works is None:
            continue
        draw_cycle(panel, leg, leg.over_cycle(power / mass(replay, leg)))
        given, taken = (float(np.mean(work)) / mass(replay, leg) for work in works)
        summaries.append(f"{leg.name} {given:+.2g} and {taken:+.2g} J/kg")
    draw_peaks(panel, POWERS.get(joint.name.split()[0], ()))
    panel.set_title(joint.name.split()[0], loc="left", fontsize=FONT)
    panel.set_ylabel(labelled("power", "W/kg"))
    return ", ".join(summaries)


def _steps(replay: Replay, legs: Legs) -> Drawing:
    figure, (length, pace, share) = panels(3, 1, height=1.6, share=True)
    found = steps(replay, legs)
    for leg in legs:
        mine = [step for step in found if step.side == leg.side]
        dots: dict[str, Any] = {
            "color": LINE[leg.side]["color"],
            "marker": "o" if leg.side == "l" else "s",
            "markersize": 4,
        }
        at = [step.at for step in mine]
        length.plot(at, [step.length for step in mine], label=leg.name, linewidth=0.8, **dots)
        pace.plot(at, [step.cadence for step in mine], linewidth=0.8, **dots)
        begun = leg.touchdowns[:-1]
        share.plot(begun, 100 * leg.share(leg.standing), label=f"stance, {leg.name}", linewidth=0.8, **dots)
    first, other = legs
    both = 100 * double_support(first, other)
    share.plot(first.touchdowns[:-1], both, color=GREY, marker="^", markersize=4, linewidth=0.8, label="double support")
    length.set_ylabel(labelled("step length", "m"))
    pace.set_ylabel(labelled("cadence", "1/min"))
    share.set_ylabel(labelled("share of stride", "%"))
    share.set_xlabel(labelled("time of touchdown", "s"))
    above(length)
    above(share)
    lengths, cadences = ([getattr(step, word) for step in found] for word in ("length", "cadence"))
    stances = 100 * np.concatenate([leg.share(leg.standing) for leg in legs])
    caption = (
        f"Each step ends with the touchdown of the leg of its colour. Over all: step length {_spread(lengths)} m, "
        f"cadence {_spread(cadences)} steps a minute, stance {_spread(stances)} % of the stride, double support "
        f"{_spread(both)} % (mean ± standard deviation). A length is that from the other foot's print to this one's."
    )
    return Drawing("gait_steps", "Steps", caption, figure)


def _spread(values: Sequence[float] | Floats) -> str:
    return f"{np.mean(values):.3g} ± {round(float(np.std(values)), 6):.2g}" if len(values) else "–"


def _margin(replay: Replay, legs: Legs) -> list[Drawing]:
    found = margin(replay, legs)
    if found is None:
        return []
    figure, (panel,) = panels(height=2.2)
    for leg in legs:
        draw_cycle(panel, leg, leg.over_cycle(100 * found))
    panel.axhline(0, color=GREY, linewidth=0.8)
    panel.set_ylabel(labelled("margin forwards", "cm"))
    panel.set_xlabel(labelled("gait cycle", "%"))
    above(panel)
    landed = [100 * float(np.mean(leg.over_cycle(found).rows[:, 0])) for leg in legs]
    caption = (
        "By how far the foremost point that stands is ahead of the extrapolated center of mass, x + v / sqrt(g / l) "
        f"with l its mean height (Hof and others 2005): {strides_text(legs)}. {BAND} At touchdown: "
        f"{' and '.join(f'{leg.name} {at:.3g} cm' for leg, at in zip(legs, landed, strict=True))}. "
        "Below 0 the next step must catch the fall forwards."
    )
    return [Drawing("gait_margin", "Margin to falling over the gait cycle", caption, figure)]


def symmetry_pairs(replay: Replay, legs: Legs) -> dict[str, tuple[float, float]]:
    """Left and right values of the quantities of a gait, each in one unit."""
    found, both = steps(replay, legs), {leg.side: leg for leg in legs}
    pairs: dict[str, Mapping[str, float]] = {
        "step length": {s: float(np.mean([step.length for step in found if step.side == s])) for s in SIDES},
        "step time": {s: float(np.mean([step.duration for step in found if step.side == s])) for s in SIDES},
        "stance": {s: float(np.mean(leg.share(leg.standing))) for s, leg in both.items()},
        "peak ground force": {s: float(np.mean(leg.highest(leg.load))) for s, leg in both.items()},
    }
    for one in matched_signals(replay, legs):
        pairs[f"range of {one.name}"] = {s: float(np.ptp(cycle.mean)) for s, cycle in one.cycles.items()}
    for name, muscle in sided_muscles(replay).items():
        activity = {s: both[s].over_cycle(replay.trajectory[f"{muscle[s]}.activation"]).mean for s in SIDES}
        pairs[f"activity of {name.replace('_', ' ')}"] = {s: float(np.mean(mean)) for s, mean in activity.items()}
    return {name: (pair["l"], pair["r"]) for name, pair in pairs.items() if pair.keys() == SIDES.keys()}


def _symmetry(replay: Replay, legs: Legs) -> Drawing:
    found = symmetry(symmetry_pairs(replay, legs))
    names = list(found)[::-1]
    figure, (panel,) = panels(height=0.4 + 0.24 * len(names))
    values = np.nan_to_num([found[name] for name in names])
    panel.set_axisbelow(True)
    colours = [LINE["r" if value > 0 else "l"]["color"] for value in values]
    panel.barh(names, values, color=colours, height=0.6)
    # A dot shows where a bar is too short to be seen.
    panel.scatter(values, names, color=colours, s=14, zorder=3)
    panel.axvline(0, color=GREY, linewidth=0.8)
    widest = max(1.0, 1.1 * float(np.max(np.abs(values))))
    panel.set_xlim(-widest, widest)
    panel.set_xlabel(labelled("right more than left", "%"))
    largest = max(found, key=lambda name: abs(np.nan_to_num(found[name])))
    caption = (
        "Symmetry: right minus left in % of their mean, 0 if both legs do the same on average, 200 if one does "
        f"nothing; a dot at 0 is a side like the other. The largest is {found[largest]:+.3g} % of {largest}."
    )
    return Drawing("gait_symmetry", "Symmetry of both legs", caption, figure)
