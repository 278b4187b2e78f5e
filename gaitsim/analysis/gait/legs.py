"""The two legs of a walker: loads, stance, and strides."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gaitsim.analysis.gait.norms import POINTS, strides
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay
from gaitsim.model import Model, Part

SIDES = {"l": "left", "r": "right"}
SETTLE = 2.0  # s: strides that begin earlier do not count, as in the measures of walking
_LEAST_STRIDES = 2
_STANCE = "measure/stance"
_SIDED = re.compile(r"(\w+)_([lr])(\..*)?")


@dataclass(frozen=True)
class Leg:
    """One leg during a run.

    Attributes:
        side: l or r.
        contacts: The addresses of its contacts.
        weight: The weight of the whole model, in N.
        load, shear: The ground force along the normal and forwards along the ground, in body weights.
        standing: 1 in stance, else 0.
        touchdowns: The times that begin or end a stride that counts, in s.
    """

    side: str
    contacts: tuple[str, ...]
    times: Floats
    weight: float
    load: Floats
    shear: Floats
    standing: Floats
    touchdowns: tuple[float, ...]

    @property
    def name(self) -> str:
        """left or right."""
        return SIDES[self.side]

    @property
    def strides(self) -> list[tuple[float, float]]:
        """Begin and end of each stride, in s."""
        return list(pairwise(self.touchdowns))

    @property
    def stances(self) -> list[slice]:
        """The instants of each stance that begins a stride."""
        found = []
        for begin, end in self.strides:
            first, last = np.searchsorted(self.times, (begin, end))
            found.append(slice(int(first), int(first + np.argmin(self.standing[first:last]))))
        return [one for one in found if one.stop > one.start]

    def over_cycle(self, values: Floats) -> Cycle:
        """A signal over the strides of this leg: strides x 101 points."""
        return Cycle(strides(self.times, values, self.touchdowns))

    def share(self, values: Floats) -> Floats:
        """The mean of a signal over each stride; for `standing` it is the share of stance."""
        return np.array([np.mean(values[inside]) for inside in self._inside], dtype=np.float64)

    def integral(self, values: Floats) -> Floats:
        """The integral of a signal over each stride; for a power it is the work."""
        seconds = np.array([end - begin for begin, end in self.strides])
        return np.asarray(seconds * self.share(values), dtype=np.float64)

    def highest(self, values: Floats) -> Floats:
        """The maximum of a signal in each stride, over all instants."""
        return np.array([np.max(values[inside]) for inside in self._inside], dtype=np.float64)

    @property
    def _inside(self) -> list[NDArray[np.bool_]]:
        return [(self.times >= begin) & (self.times < end) for begin, end in self.strides]


@dataclass(frozen=True)
class Cycle:
    """A signal over the gait cycle: strides x 101 points, from touchdown to touchdown."""

    rows: Floats

    @property
    def mean(self) -> Floats:
        """The mean over the strides."""
        return np.asarray(np.mean(self.rows, axis=0), dtype=np.float64)

    @property
    def deviation(self) -> Floats:
        """The standard deviation over the strides."""
        return np.asarray(np.std(self.rows, axis=0), dtype=np.float64)


PERCENT = np.linspace(0, 100, POINTS)


def side_of(address: str) -> str:
    """The side of an address: l or r if its first word ends with _l or _r, as in leg_l.knee; else empty."""
    found = _SIDED.fullmatch(address)
    return found[2] if found else ""


def on_side(address: str, side: str) -> str:
    """The same address on another side: leg_l.knee.angle becomes leg_r.knee.angle."""
    found = _SIDED.fullmatch(address)
    return address if found is None else f"{found[1]}_{side}{found[3] or ''}"


def unsided(address: str) -> str:
    """The name of an address within its side: leg_l.knee.angle becomes knee.angle."""
    return address.partition(".")[2] if side_of(address) else address


def two_legs(replay: Replay) -> tuple[Leg, Leg] | None:
    """The left and the right leg, if both sides touch the ground and take at least two strides; else None.

    A leg is a side: its load is the sum over all contacts whose addresses begin with a word that ends with _l or _r.
    """
    contacts = {side: _contacts(replay.model, side) for side in SIDES}
    if len(replay.times) < 2 or not has_two_legs(replay.model):
        return None
    left, right = (_leg(replay, side, contacts[side]) for side in SIDES)
    settled = [_from(leg, SETTLE) for leg in (left, right)] if replay.times[0] < SETTLE else [left, right]
    chosen = settled if min(len(leg.strides) for leg in settled) >= _LEAST_STRIDES else [left, right]
    return (chosen[0], chosen[1]) if min(len(leg.strides) for leg in chosen) >= _LEAST_STRIDES else None


def has_two_legs(model: Model) -> bool:
    """Whether both sides of a model can touch the ground."""
    return all(_contacts(model, side) for side in SIDES)


def _contacts(model: Model, side: str) -> tuple[str, ...]:
    return tuple(p.address for p in model.parts if p.type.kind == "contact" and side_of(p.address) == side)


def _leg(replay: Replay, side: str, contacts: tuple[str, ...]) -> Leg:
    signals, times = replay.trajectory, replay.times
    load = np.sum([signals[f"{c}.load"] for c in contacts], axis=0)
    weight = _weight(replay, contacts)
    friction = np.sum([signals[f"{c}.friction_force"] for c in contacts], axis=0)
    shear = friction / weight if weight > 0 else np.zeros(len(times))
    standing = stands(times, load, *_rule(replay.model, side))
    landings = np.flatnonzero((standing[1:] > 0.5) & (standing[:-1] < 0.5)) + 1
    return Leg(side, contacts, times, weight, load, shear, standing, tuple(float(times[i]) for i in landings))


def _weight(replay: Replay, contacts: tuple[str, ...]) -> float:
    """The weight of the model in N: force over load where a contact is loaded most; 0 if no contact is ever loaded."""
    for contact in contacts:
        force, load = replay.trajectory[f"{contact}.force"], replay.trajectory[f"{contact}.load"]
        most = int(np.argmax(load))
        if load[most] > 0:
            return float(force[most] / load[most])
    return 0.0


def _rule(model: Model, side: str) -> tuple[float, float]:
    """Threshold and hold time of the model's measure of stance on a side; its defaults without such a measure."""
    values = model.values()
    senders = {c.target: c.sender for c in model.connections}
    for part in model.parts:
        if part.type.reference == _STANCE and side_of(senders.get(f"{part.address}.load", "")) == side:
            return values[part.numbers["threshold"]], values[part.numbers["hold"]]
    return 0.05, 0.02


def stands(times: Floats, load: Floats, threshold: float, hold: float) -> Floats:
    """Detect stance by the rule of measure/stance, without its delay.

    Args:
        times: In s.
        load: In body weights.
        threshold: The load above which the leg is in stance.
        hold: The shortest duration of a change, in s; shorter changes are ignored.

    Returns:
        1 in stance, else 0, for each instant.
    """
    above = load > threshold
    edges = [0, *(np.flatnonzero(above[1:] != above[:-1]) + 1).tolist(), len(load)]
    step = float(times[1] - times[0])
    standing = np.zeros(len(load))
    phase = bool(above[0])
    for begin, end in pairwise(edges):
        if (end - begin) * step >= hold - 1e-6 * step:
            phase = bool(above[begin])
        standing[begin:end] = phase
    return standing


def _from(leg: Leg, begin: float) -> Leg:
    return replace(leg, touchdowns=tuple(t for t in leg.touchdowns if t >= begin))


def mass(replay: Replay, leg: Leg) -> float:
    """The mass of the whole model, in kg."""
    return leg.weight / replay.model.simulate.gravity


def part_at(model: Model, address: str) -> Part | None:
    """The part with an address, or the part with the signal of that address."""
    owner = address.rpartition(".")[0]
    return next((p for p in model.parts if p.address in (address, owner)), None)
