"""The single steps of a walker: length, cadence, stance, double support, margin of stability, and symmetry."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gaitsim.analysis.gait.legs import Leg, unsided
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay
from gaitsim.model import Model

_CENTER = "sensor/center_of_mass"
_FLAT = "terrain/flat"


@dataclass(frozen=True)
class Step:
    """A step: from the touchdown of the other foot to that of this one.

    Attributes:
        side: The side of this foot.
        at: The time of this touchdown, in s.
        length: In m.
        duration: In s.
    """

    side: str
    at: float
    duration: float
    length: float

    @property
    def cadence(self) -> float:
        """Steps per minute, if all were like this one."""
        return 60 / self.duration


def steps(replay: Replay, legs: Sequence[Leg]) -> list[Step]:
    """The steps between touchdowns of alternate feet. A foot that lands twice in a row makes no step.

    The length is the distance between two footprints: where the landing part of the foot, such as the heel, touched
    down, and where the same part of the other foot had touched down before.
    """
    found = []
    for (before, other), (at, leg) in pairwise(landings(legs)):
        if other.side == leg.side or at <= before:
            continue
        contact = landing_contact(replay, leg, at)
        twin = next((c for c in other.contacts if unsided(c) == unsided(contact)), other.contacts[0])
        length = _position(replay, contact, at) - _position(replay, twin, before)
        found.append(Step(leg.side, at, at - before, length))
    return found


def landings(legs: Sequence[Leg]) -> list[tuple[float, Leg]]:
    """All touchdowns in order: time in s, and leg."""
    return sorted(((at, leg) for leg in legs for at in leg.touchdowns), key=lambda landing: landing[0])


def landing_contact(replay: Replay, leg: Leg, at: float) -> str:
    """The contact of a leg that is loaded most at its touchdown."""
    index = int(np.searchsorted(replay.times, at))
    return max(leg.contacts, key=lambda contact: float(replay.trajectory[f"{contact}.load"][index]))


def _position(replay: Replay, contact: str, at: float) -> float:
    return float(np.interp(at, replay.times, replay.trajectory[f"{contact}.position"]))


def double_support(leg: Leg, other: Leg) -> Floats:
    """The share of each stride of a leg in which both legs are in stance."""
    return leg.share(leg.standing * other.standing)


def margin(replay: Replay, legs: Sequence[Leg]) -> Floats | None:
    """The margin of stability: the distance in m of the foremost standing contact ahead of the extrapolated center
    of mass.

    The latter is x + v / sqrt(g / l), where l is the mean height of the center of mass (Hof and others 2005). Below 0,
    a step is needed to prevent a fall forwards.

    Returns:
        A value for each instant, nan in flight; None without a sensor/center_of_mass or with ground that is not flat.
    """
    sensor = center_of(replay.model)
    if sensor is None or not on_level_ground(replay.model):
        return None
    signals = replay.trajectory
    pace = np.sqrt(replay.model.simulate.gravity / np.mean(signals[f"{sensor}.height"]))
    ahead = signals[f"{sensor}.forward"] + signals[f"{sensor}.forward_velocity"] / pace
    contacts = [contact for leg in legs for contact in leg.contacts]
    reached = [np.where(signals[f"{c}.load"] > 0, signals[f"{c}.position"], -np.inf) for c in contacts]
    front = np.max(reached, axis=0)
    return np.asarray(np.where(np.isfinite(front), front, np.nan) - ahead, dtype=np.float64)


def lacks_center(model: Model) -> bool:
    """Whether the margin of stability is missing only because there is no sensor/center_of_mass."""
    return center_of(model) is None and on_level_ground(model)


def center_of(model: Model) -> str | None:
    """The address of the sensor of the center of mass; None without one."""
    return next((p.address for p in model.parts if p.type.reference == _CENTER), None)


def on_level_ground(model: Model) -> bool:
    """Whether all ground of a model is flat."""
    return {p.type.reference for p in model.parts if p.type.kind == "terrain"} <= {_FLAT}


def symmetry_index(left: float, right: float) -> float:
    """The right side minus the left one, in % of the mean of their magnitudes; nan if both are 0."""
    size = (abs(left) + abs(right)) / 2
    return 100 * (right - left) / size if size > 0 else float("nan")


def symmetry(pairs: Mapping[str, tuple[float, float]]) -> dict[str, float]:
    """The symmetry index of each named pair of left and right values."""
    return {name: symmetry_index(*pair) for name, pair in pairs.items()}
