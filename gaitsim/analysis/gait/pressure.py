"""The center of pressure under a foot during stance, measured from the print of the heel, forwards along the ground."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gaitsim.analysis.drawings.drawing import Drawing
from gaitsim.analysis.drawings.style import FONT, GREY, above, labelled, panels
from gaitsim.analysis.gait.legs import Cycle, Leg, unsided
from gaitsim.analysis.gait.norms import POINTS
from gaitsim.analysis.gait.panels import BAND, draw_band, strides_text
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay


@dataclass(frozen=True)
class Pressure:
    """The center of pressure of one foot during its stances, in m; 0 is where the heel stood.

    Attributes:
        heel, front: The hindmost and the foremost contact of the foot.
        length: The distance between them in m, where the foot is flat.
    """

    leg: Leg
    heel: str
    front: str
    length: float
    over_stance: Cycle

    @property
    def middle_at(self) -> float:
        """The share of stance, 0 to 1, at which the mean passes the middle of the foot; nan if it never does.

        If it passes several times, the last time counts: a foot that slaps down is on its ball for a moment and then on
        its heel again, and it is chance whether the mean of such moments lies beyond the middle.
        """
        beyond = self.over_stance.mean > self.length / 2
        passing = np.flatnonzero(beyond & ~np.concatenate([[False], beyond[:-1]]))
        return float(passing[-1]) / (POINTS - 1) if passing.size else float("nan")


def pressure(replay: Replay, leg: Leg) -> Pressure | None:
    """The center of pressure of a leg; None if it touches the ground at one place only.

    It is the mean of the positions of the foot's contacts, weighted by their normal forces. The print of the heel is
    the same mean for the heel alone, or its position at touchdown if it is never loaded.
    """
    places = {c: replay.trajectory[f"{c}.position"] for c in leg.contacts}
    forces = {c: np.maximum(0, replay.trajectory[f"{c}.force"]) for c in leg.contacts}
    standing = leg.standing > 0.5
    ahead = {c: float(np.mean(place[standing])) for c, place in places.items()}
    heel, front = min(ahead, key=ahead.__getitem__), max(ahead, key=ahead.__getitem__)
    length = max((float(np.max(places[front][one] - places[heel][one])) for one in leg.stances), default=0.0)
    if length <= 0:
        return None
    total = np.sum(list(forces.values()), axis=0)
    moment = np.sum([places[c] * forces[c] for c in leg.contacts], axis=0)
    rows = []
    for one in leg.stances:
        loaded = total[one] > 0
        at, share = leg.times[one], np.linspace(leg.times[one][0], leg.times[one][-1], POINTS)
        center = np.interp(share, at[loaded], moment[one][loaded] / total[one][loaded])
        rows.append(center - _print(places[heel][one], forces[heel][one]))
    return Pressure(leg, heel, front, length, Cycle(np.array(rows)))


def _print(place: Floats, force: Floats) -> float:
    carried = float(np.sum(force))
    return float(np.sum(place * force)) / carried if carried > 0 else float(place[0])


def pressure_figures(replay: Replay, legs: Sequence[Leg]) -> list[Drawing]:
    """The center of pressure of both feet during stance."""
    found = [one for leg in legs if (one := pressure(replay, leg)) is not None]
    if not found:
        return []
    figure, (panel,) = panels(height=2.4)
    for one in found:
        draw_band(panel, one.leg, one.over_stance, 100)
    length = 100 * float(np.mean([one.length for one in found]))
    for edge in (0, length):
        panel.axhline(edge, color=GREY, linewidth=0.8, linestyle=":")
    panel.set_ylabel(labelled("from the heel", "cm"))
    panel.set_xlabel(labelled("stance", "%"))
    shares = panel.secondary_yaxis("right", functions=(_times(1 / length), _times(length)))
    shares.set_ylabel(labelled("foot lengths", "1"), fontsize=FONT)
    shares.tick_params(labelsize=FONT - 1)
    above(panel)
    summaries = "; ".join(_summary(one) for one in found)
    caption = (
        "Center of pressure of each foot, forwards from its heel's print along the ground: "
        f"{strides_text(legs, until='take-off')}. {BAND} Dotted: the foot's hindmost contact "
        f"({_named(found, 'heel')}) and its foremost one ({_named(found, 'front')}), a foot length apart. "
        f"Mean: {summaries}."
    )
    return [Drawing("gait_pressure", "Center of pressure over stance", caption, figure)]


def _times(factor: float) -> Callable[[ArrayLike], ArrayLike]:
    return lambda values: factor * np.asarray(values, dtype=np.float64)


def _named(found: Sequence[Pressure], which: str) -> str:
    return " and ".join(dict.fromkeys(unsided(getattr(one, which)) for one in found))


def _summary(one: Pressure) -> str:
    mean = 100 * one.over_stance.mean
    passing = "never beyond" if np.isnan(one.middle_at) else f"at {100 * one.middle_at:.0f} % of stance past"
    return (
        f"{one.leg.name} from {mean[0]:.1f} to {mean[-1]:.1f} cm, {passing} the middle of a foot of "
        f"{100 * one.length:.3g} cm"
    )
