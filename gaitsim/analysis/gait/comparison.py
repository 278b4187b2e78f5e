"""Comparison of a walker's signals with recorded curves of people."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from gaitsim.analysis.gait.joint_moments import joint_moment
from gaitsim.analysis.gait.legs import SIDES, Cycle, Leg, mass, on_side, part_at, two_legs
from gaitsim.analysis.gait.norms import RUNNING, WALKING, Comparison, Norm, compared, read_norm
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay
from gaitsim.components.find import Library, library_folders
from gaitsim.errors import InvalidSpec
from gaitsim.model import Model, Part
from gaitsim.results.bundle import COMPONENTS
from gaitsim.units import parse_unit

_GAIT_CURVE = "measure/gait_curve"
_MOMENTS = f"{WALKING}_moments"
# The moment that people's tables have beside an angle; it grows against the angle.
_MOMENT_OF = {
    "hip_flexion": "hip_extension_moment",
    "knee_flexion": "knee_extension_moment",
    "ankle_dorsiflexion": "ankle_plantarflexion_moment",
}


@dataclass(frozen=True)
class ComparedSignal:
    """A signal that a measure of the model compares with a recorded curve, for both sides.

    Attributes:
        norm: The recorded curve.
        signal: The address of the signal on one side.
        zero, direction: The curve is compared with direction * (signal - zero), in SI.
    """

    norm: Norm
    signal: str
    zero: float
    direction: float

    @property
    def name(self) -> str:
        """The name of the curve in words, such as hip flexion."""
        return self.norm.name.rpartition(".")[2].replace("_", " ")

    def on(self, replay: Replay, side: str) -> Floats | None:
        """The signal of a side in the convention of the curve; None if the side does not have it."""
        address = on_side(self.signal, side)
        if address not in replay.trajectory.signals:
            return None
        return self.direction * (replay.trajectory[address] - self.zero)


@dataclass(frozen=True)
class ComparedQuantity:
    """One quantity of both legs over the gait cycle, with that of people.

    Attributes:
        cycles: By side.
    """

    name: str
    norm: Norm
    cycles: dict[str, Cycle]

    def comparison(self, side: str) -> Comparison:
        """The mean stride of a side compared with people's mean."""
        return compared(self.cycles[side].mean, self.norm)


def library_of(replay: Replay) -> Library:
    """The library with the tables and components of the run, then those of this machine."""
    own = [replay.folder / COMPONENTS] if replay.folder else []
    return Library((*own, *library_folders(None if replay.folder else replay.path)))


def compared_signals(replay: Replay) -> list[ComparedSignal]:
    """The signals that the gait_curve measures of a model follow, each once for both sides."""
    model, library = replay.model, library_of(replay)
    found: dict[tuple[str, str], ComparedSignal] = {}
    for part in model.parts:
        if part.type.reference != _GAIT_CURVE:
            continue
        signal = next((c.sender for c in model.connections if c.target == f"{part.address}.signal"), None)
        if signal is None:
            continue
        norm = _norm(model, part, signal, library)
        values = model.values()
        zero, direction = (values[part.numbers[name]] for name in ("zero", "direction"))
        found.setdefault((norm.name, on_side(signal, "l")), ComparedSignal(norm, signal, zero, direction))
    return list(found.values())


def runs(replay: Replay) -> bool:
    """Whether a model is compared with runners, so that data of walking does not apply."""
    return any(one.norm.name.startswith(RUNNING) for one in compared_signals(replay))


def _norm(model: Model, part: Part, signal: str, library: Library) -> Norm:
    """The recorded curve of a measure, with its deviation if the table is available."""
    recording = part.series["curve"]
    table, _, column = recording.column.rpartition(".")
    try:
        return read_norm(column, library, table)
    except (InvalidSpec, KeyError):
        name = recording.column or part.address
        return Norm(name, _unit(model, signal), np.array(recording.values), None, recording.source)


def _unit(model: Model, signal: str) -> str:
    part = part_at(model, signal)
    return part.type.outputs[signal.rpartition(".")[2]].unit if part else "1"


def matched_signals(replay: Replay, legs: Sequence[Leg]) -> list[ComparedQuantity]:
    """The compared signals of both legs."""
    found = []
    for one in compared_signals(replay):
        cycles = {leg.side: leg.over_cycle(v) for leg in legs if (v := one.on(replay, leg.side)) is not None}
        found.append(ComparedQuantity(one.name, one.norm, cycles))
    return [one for one in found if one.cycles]


def matched_moments(replay: Replay, legs: Sequence[Leg]) -> list[ComparedQuantity]:
    """Joint moments divided by body mass, for joints with compared angles, in the sign convention of the table of
    people.

    Returns:
        The moments; empty for a runner, because the table is of walking.
    """
    library, found = library_of(replay), []
    if runs(replay):
        return []
    for one in compared_signals(replay):
        column = _MOMENT_OF.get(one.norm.name.rpartition(".")[2])
        if column is None:
            continue
        cycles = {}
        for leg in legs:
            moment = joint_moment(replay, on_side(one.signal, leg.side).rpartition(".")[0])
            if moment is not None:
                cycles[leg.side] = leg.over_cycle(-one.direction * moment / mass(replay, leg))
        if cycles:
            found.append(ComparedQuantity(column.replace("_", " "), read_norm(column, library, _MOMENTS), cycles))
    return found


def norm_numbers(replay: Replay) -> dict[str, dict[str, dict[str, Any]]]:
    """The comparison of a walker with people, by curve and by leg (left, right); empty unless it walks on two legs.

    Angles are in the unit of the curve, shares of the cycle in %. Differences are those of the model minus those of
    people.
    """
    legs = two_legs(replay)
    if legs is None:
        return {}
    both = [*matched_signals(replay, legs), *matched_moments(replay, legs)]
    return {
        one.norm.name: {SIDES[side]: _numbers(one, side, len(cycle.rows)) for side, cycle in one.cycles.items()}
        for one in both
    }


def _numbers(one: ComparedQuantity, side: str, count: int) -> dict[str, Any]:
    found, factor = one.comparison(side), parse_unit(one.norm.unit).factor
    banded = one.norm.deviation is not None
    return {
        "unit": one.norm.unit,
        "strides": count,
        "correlation": None if math.isnan(found.correlation) else found.correlation,
        "error": found.error / factor,
        "shape_error": found.shape_error / factor,
        "range_of_motion": found.reach / factor,
        "range_of_motion_difference": (found.reach - found.norm_reach) / factor,
        "timing_difference": later(found.highest_at, found.norm_highest_at),
        "lowest_timing_difference": later(found.lowest_at, found.norm_lowest_at),
        "fit": found.fit if banded else None,
        "shape_fit": found.shape_fit if banded else None,
    }


def later(place: float, norm_place: float) -> float:
    """By how much of the cycle in % one position (0 to 1) is later than another, the shorter way: -50 to 50."""
    return 100 * ((place - norm_place + 0.5) % 1.0 - 0.5)
