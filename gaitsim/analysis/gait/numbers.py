"""The numbers of a walker's gait for each leg, and the comparison of its curves with people, as data and as tables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from gaitsim.analysis.drawings.style import shown_unit
from gaitsim.analysis.drawings.table import Table, formatted
from gaitsim.analysis.gait.comparison import compared_signals, norm_numbers
from gaitsim.analysis.gait.figures import symmetry_pairs
from gaitsim.analysis.gait.footsteps import double_support, margin, steps, symmetry
from gaitsim.analysis.gait.joint_moments import joint_work
from gaitsim.analysis.gait.legs import SIDES, Leg, mass, on_side, two_legs
from gaitsim.analysis.gait.muscles import metabolic_power
from gaitsim.analysis.gait.path_work import created_power
from gaitsim.analysis.gait.pressure import pressure
from gaitsim.analysis.replays.cycles import Floats
from gaitsim.analysis.replays.replay import Replay

Legs = Sequence[Leg]
_LEAST_WORK = 1e-9  # J/kg; less is rounding
# name, unit, and by side a value for each step or stride
Quantity = tuple[str, str, dict[str, Floats]]


def gait_numbers(replay: Replay) -> dict[str, dict[str, Any]]:
    """For each quantity: its unit, mean and standard deviation over strides or steps, and the means of left and
    right.

    `symmetry` has right minus left in % of their mean.

    Returns:
        The numbers; empty unless the model walks on two legs.
    """
    legs = two_legs(replay)
    if legs is None:
        return {}
    found: dict[str, dict[str, Any]] = {"strides": {SIDES[leg.side]: len(leg.strides) for leg in legs}}
    for name, unit, values in _quantities(replay, legs):
        every = np.concatenate([each for each in values.values() if each.size] or [np.array([math.nan])])
        means = {SIDES[side]: _number(each) for side, each in values.items()}
        deviation = None if np.isnan(every).any() else float(np.std(every))
        found[name] = {"unit": unit, "mean": _number(every), "deviation": deviation, **means}
    indices = symmetry(symmetry_pairs(replay, legs))
    found["symmetry"] = {"unit": "%", **{name: None if math.isnan(at) else at for name, at in indices.items()}}
    return found


def _number(values: Floats) -> float | None:
    return None if not values.size or np.isnan(values).any() else float(np.mean(values))


def _quantities(replay: Replay, legs: Legs) -> Iterator[Quantity]:
    yield from _of_steps(replay, legs)
    yield from _of_forces(legs)
    yield from _of_pressure(replay, legs)
    yield from _of_energy(replay, legs)
    ahead = margin(replay, legs)
    if ahead is not None:
        yield "margin_at_touchdown", "m", {leg.side: leg.over_cycle(ahead).rows[:, 0] for leg in legs}


def _of_steps(replay: Replay, legs: Legs) -> Iterator[Quantity]:
    found = steps(replay, legs)
    of = {side: [step for step in found if step.side == side] for side in SIDES}
    yield "step_length", "m", {side: np.array([step.length for step in mine]) for side, mine in of.items()}
    yield "step_time", "s", {side: np.array([step.duration for step in mine]) for side, mine in of.items()}
    yield "cadence", "1/min", {side: np.array([step.cadence for step in mine]) for side, mine in of.items()}
    yield "stance", "%", {leg.side: 100 * leg.share(leg.standing) for leg in legs}
    left, right = legs
    yield "double_support", "%", {"l": 100 * double_support(left, right), "r": 100 * double_support(right, left)}


def _of_forces(legs: Legs) -> Iterator[Quantity]:
    """Peaks of the ground forces in body weights, over all instants of each stride."""
    yield "peak_force", "1", {leg.side: leg.highest(leg.load) for leg in legs}
    yield "braking", "1", {leg.side: -leg.highest(-leg.shear) for leg in legs}
    yield "propulsion", "1", {leg.side: leg.highest(leg.shear) for leg in legs}


def _of_pressure(replay: Replay, legs: Legs) -> Iterator[Quantity]:
    """The center of pressure from the print of the heel: at touchdown, at take-off, and the time at which it passes
    the middle of the foot.
    """
    found = {leg.side: one for leg in legs if (one := pressure(replay, leg)) is not None}
    if not found:
        return
    yield "foot_length", "m", {side: np.array([one.length]) for side, one in found.items()}
    rows = {side: one.over_stance.rows for side, one in found.items()}
    yield "center_of_pressure_at_touchdown", "m", {side: each[:, 0] for side, each in rows.items()}
    yield "center_of_pressure_at_takeoff", "m", {side: each[:, -1] for side, each in rows.items()}
    yield "center_of_pressure_mean", "m", {side: np.mean(each, axis=1) for side, each in rows.items()}
    yield "center_of_pressure_past_middle", "%", {s: np.array([100 * one.middle_at]) for s, one in found.items()}


def _of_energy(replay: Replay, legs: Legs) -> Iterator[Quantity]:
    for one in compared_signals(replay):
        joint = one.name.split()[0]
        works = [joint_work(replay, leg, on_side(one.signal, leg.side).rpartition(".")[0]) for leg in legs]
        known = {
            leg.side: np.array(work) / mass(replay, leg)
            for leg, work in zip(legs, works, strict=True)
            if work is not None
        }
        if known:
            yield f"{joint}_positive_work", "J/kg", {side: work[0] for side, work in known.items()}
            yield f"{joint}_negative_work", "J/kg", {side: work[1] for side, work in known.items()}
    created = {leg.side: leg.integral(created_power(replay, leg.side)) / mass(replay, leg) for leg in legs}
    if any(np.abs(work).max(initial=0) > _LEAST_WORK for work in created.values()):
        yield "work_created_at_paths", "J/kg", created
    powers = {leg.side: leg.share(power) for leg in legs if (power := metabolic_power(replay, leg)) is not None}
    if powers:
        yield "metabolic_power", "W/kg", powers


def gait_table(replay: Replay) -> Table | None:
    """The numbers of a gait; None unless the model walks on two legs."""
    found = {name: row for name, row in gait_numbers(replay).items() if "mean" in row}
    columns = ("gait", "unit", "mean", "deviation", "left", "right")
    rows = tuple(
        (name, shown_unit(row["unit"]), *(_formatted(row.get(word), 4) for word in columns[2:]))
        for name, row in found.items()
    )
    return Table(columns, rows, frozenset(range(2, 6))) if rows else None


def norms_table(replay: Replay) -> Table | None:
    """The curves of each leg beside those of people; None without any."""
    columns = ("curve", "leg", "correlation", "RMSE", "range", "people's range", "peak later by (%)", "fit (%)")
    rows = tuple(
        (
            f"{curve.rpartition('.')[2]} ({shown_unit(row['unit'])})",
            leg,
            *(_formatted(each, 3) for each in _compared(row)),
        )
        for curve, legs in norm_numbers(replay).items()
        for leg, row in legs.items()
    )
    return Table(columns, rows, frozenset(range(2, len(columns)))) if rows else None


def _compared(row: Mapping[str, Any]) -> list[float | None]:
    reach = row["range_of_motion"]
    people = reach - row["range_of_motion_difference"]
    return [row["correlation"], row["error"], reach, people, row["timing_difference"], row["fit"]]


def _formatted(number: float | None, digits: int) -> str:
    """A number as text; rounding errors become 0."""
    return formatted(None if number is None else round(number, 9), digits)
