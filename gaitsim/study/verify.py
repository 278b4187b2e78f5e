"""Verification of results: candidates are run again from the result's own copies and compared bit for bit."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from gaitsim.cluster.episodes import bundle_episodes
from gaitsim.errors import InvalidComponent, InvalidSpec
from gaitsim.optimization.evaluation import Evaluation
from gaitsim.optimization.journal import evaluations_in
from gaitsim.results.bundle import BadResult, Bundle
from gaitsim.results.rows import COMPARED, read_rows, row_starts
from gaitsim.results.store import row_data
from gaitsim.simulation.batch import failed_by
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.inheritance import override
from gaitsim.spec.resolve import resolve

_ENDED = ("killed", "timeout")  # candidates that hung or killed a worker would do so again


@dataclass(frozen=True)
class Check:
    """One candidate that was run again: its name and the differences.

    Attributes:
        largest: The largest relative difference of a number; inf if something else differs, 0 if nothing does.
    """

    name: str
    differs: tuple[str, ...]
    largest: float


def verified(bundle: Bundle, manifest: Mapping[str, Any], everything: bool) -> Iterator[Check]:
    """Run candidates of a result again.

    Args:
        bundle: The bundle of the result.
        manifest: Its manifest.
        everything: Whether to run all candidates, instead of the best, the start and some others.

    Raises:
        BadResult: The folder is not a result, or the result is damaged.
        DamagedJournal: The journal is damaged.
        InvalidSpec: The spec breaks a rule.
    """
    mode: Mode = "normal" if manifest["mode"] == "normal" else "rapid"
    if manifest["kind"] == "run":
        yield from _runs(bundle, mode)
        return
    episodes = bundle_episodes(bundle, mode)
    found = [e for e in evaluations_in(bundle.folder) if e.verdict.status not in _ENDED]
    if not found:
        raise BadResult(f"{bundle.folder}: nothing was evaluated yet, so there is nothing to verify.")
    for evaluation in found if everything else _sample(found):
        place = evaluation.candidate
        before, now = vars(evaluation.verdict), vars(episodes.verdict(place.x))
        yield _check(f"{place.generation}:{place.index}", before, now)


def _runs(bundle: Bundle, mode: Mode) -> Iterator[Check]:
    document, library, starts = bundle.document(), bundle.library(), bundle.starts()
    for i, row in enumerate(read_rows(bundle.folder)):
        if row["status"] in _ENDED:
            continue
        variant = document
        for address, text in row["settings"].items():
            variant = override(variant, address, text)
        try:
            model = resolve(variant, library, bundle.name).started_at(starts | row_starts(row))
            outcome = Simulator(model, mode).run()
        except (InvalidSpec, InvalidComponent) as error:
            outcome = failed_by(error)
        now = row_data(row["settings"], outcome)
        yield _check(", ".join(f"{a}={v}" for a, v in row["settings"].items()) or f"run {i}", row, now)


def _check(name: str, before: Mapping[str, Any], now: Mapping[str, Any]) -> Check:
    pairs = list(_pairs(before, now))
    off = [_relative(old, new) for _, old, new in pairs if old != new]
    return Check(name, differences(before, now), max(off, default=0.0))


def _relative(old: object, new: object) -> float:
    """The difference of two numbers relative to the larger one; inf if one is not a number, and for counts."""
    if not (isinstance(old, float) and isinstance(new, float)):
        return math.inf
    return abs(new - old) / max(abs(old), abs(new))


def differences(before: Mapping[str, Any], now: Mapping[str, Any]) -> tuple[str, ...]:
    """The differences of two runs in the form of `row_data`, in words. Numbers are compared bit for bit."""
    return tuple(f"{what}: {old!r} -> {new!r}" for what, old, new in _pairs(before, now) if old != new)


def _pairs(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[tuple[str, Any, Any]]:
    """The names of what is compared of two runs, with both values."""
    for name in COMPARED:
        if name == "metrics":
            both = [*before["metrics"], *(m for m in now["metrics"] if m not in before["metrics"])]
            yield from ((m, before["metrics"].get(m), now["metrics"].get(m)) for m in both)
        else:
            yield name, before[name], now[name]


def _sample(found: list[Evaluation]) -> list[Evaluation]:
    """The best, the first and the last candidate, and some evenly between."""
    count = min(len(found), 10)
    even = {round(i * (len(found) - 1) / max(1, count - 1)) for i in range(count)}
    best = min(range(len(found)), key=lambda i: found[i].cost)
    return [found[i] for i in sorted(even | {best})]
