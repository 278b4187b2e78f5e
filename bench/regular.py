"""Search for a robust walk in space: `python bench/regular.py SPEC MINUTES --to values.json`.

The time until a fall says little while all candidates fall. How far touchdowns differ from one another says more: the
cost of a run is the mean square of six deviations from their medians over its touchdowns. They are roll and pitch of
the pelvis, lateral velocity of the center of mass and its distance to the side of the new foot, both relative to the
heading, duration of the step, and speed; signs are mirrored on the left. A touchdown that a fall prevents costs 9.

A robust walk bears changes of its values. The cost of a candidate is the mean over runs in which all values are changed
at random by up to 1 %, the same for all candidates of a generation.

A reflex G (l - l_0) can hardly change if G and l_0 change on their own: both alter the mean stimulation, and the walker
falls. The search therefore changes a gain together with its offset, so that the stimulation at the mean length stays.
The mean is that of the lengths at which the reflex acts in the first run. Gains then bear changes of 15 %.

With `--people W`, W times the terms of `unlike_people` are added: what is beyond people's range, and effort.

The search is an evolution strategy of constant spreads with mirrored candidates: its center moves to the weighted mean
of the better half. A spread is smaller for a change that raises the cost much. It writes the mean of the last centers,
and prints how long that walks if all values are changed at random by up to 1 %.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from touchdowns import SCALES, touchdowns

from gaitsim.model import Model
from gaitsim.simulation.outcome import Outcome, Trajectory
from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

MOST = 9.0  # cost of a touchdown that differs much, or is missing
SETTLED = 2  # touchdowns before the first that counts
USUAL = 0.56  # s: between touchdowns
SHARE = 0.01  # largest relative change of a value
SUMS = ("offset", "setpoint", "bias")  # values that change by sums
STEADY = 2.5  # s: after this, lengths count
STRIDE = 1.1  # s: about one, for ranges of signals
LARGEST = 0.15  # spread of a factor's logarithm
TOLERATED = 0.3  # rise of the cost for a third of it
LAST = 10  # generations whose centers are averaged


@dataclass
class Walks:
    """Runs of one model.

    Attributes:
        model: The model.
        slowest: Speed in m/s below which a walk costs more.
        people: Weight of the difference from people.
    """

    model: Model
    slowest: float = 1.0
    people: float = 0.0

    def __post_init__(self) -> None:
        self.simulator = Simulator(self.model)
        self.low, self.high = (np.array([getattr(free, end) for free in self.model.free]) for end in ("low", "high"))

    def run(self, x: Any) -> Outcome:
        """Run a candidate, within the bounds."""
        return self.simulator.run(np.clip(x, self.low, self.high).tolist(), recorded=True)

    def cost(self, x: Any) -> float:
        """How far the steps of a walk differ, and how much it is too slow."""
        outcome, duration = self.run(x), self.model.simulate.duration
        rows = self._rows(outcome)
        if len(rows) <= SETTLED + 1:
            return MOST * (2 - outcome.simulated_seconds / duration)
        wanted = int(duration / USUAL)
        rows = rows[SETTLED:wanted]
        each = np.minimum(MOST, np.mean(((rows - np.median(rows, axis=0)) / SCALES) ** 2, axis=1))
        missing = max(0, wanted - SETTLED - len(rows)) if outcome.status != "completed" else 0
        slow = max(0.0, self.slowest - float(np.median(rows[:, 5])))
        cost = float((each.sum() + MOST * missing) / (len(rows) + missing) + 10 * slow)
        assert outcome.trajectory is not None
        return cost + (self.people * unlike_people(outcome.trajectory) if self.people else 0.0)

    def lasts(self, x: Any) -> float:
        """How long a candidate stays up, in s."""
        return self.run(x).simulated_seconds

    def _rows(self, outcome: Outcome) -> Any:
        found = outcome.trajectory
        return touchdowns(found) if found is not None and len(found.times) > 1 else np.zeros((0, 6))


def unlike_people(found: Trajectory) -> float:
    """How far a walk is beyond people's range in rotation and obliquity of the pelvis, knee flexion and peaks of the
    load, how much the peaks of both legs differ, and the mean squared activation; 0 if it is too short to tell.
    """
    count = int((found.times[-1] - STEADY) / STRIDE)
    if count < 1:
        return 0.0
    ends = np.searchsorted(found.times, STEADY + STRIDE * np.arange(count + 1))

    def usual(of: Any, signal: str) -> float:
        return float(np.median([of(found[signal][a:b]) for a, b in itertools.pairwise(ends)]))

    knee = sum(usual(np.min, f"leg_{side}.knee.angle") for side in "lr") / 2
    peaks = [usual(np.max, f"leg_{side}.ground.load") for side in "lr"]
    beyond = 20 * max(0.0, usual(np.ptp, "root.yaw") - 0.235) + 100 * max(0.0, usual(np.ptp, "root.roll") - 0.2)
    beyond += 80 * max(0.0, 0.985 + knee)
    blows = 5 * max(0.0, sum(peaks) / 2 - 1.24) + 15 * abs(peaks[0] - peaks[1])
    late = found.times > STEADY
    muscles = [name for name in found.signals if name.endswith(".activation") and name.count(".") == 2]
    return beyond + blows + 10 * float(np.mean([np.mean(found[name][late] ** 2) for name in muscles]))


_WALKS: list[Walks] = []  # of this process


def _prepare(spec: Path, settings: tuple[str, ...], slowest: float, people: float) -> None:
    _WALKS[:] = [Walks(Opening(spec, settings).open().model(), slowest, people)]


def _called(method: str, x: Any) -> Any:
    return getattr(_WALKS[0], method)(x)


@dataclass
class Pool:
    """Calls methods of `Walks` in two processes."""

    processes: ProcessPoolExecutor

    def each(self, method: str, candidates: list[Any]) -> list[Any]:
        """The results of a method for some candidates."""
        return list(self.processes.map(_called, [method] * len(candidates), candidates, chunksize=4))


class Changes:
    """What the search changes: gains by factors, with their offsets, and all else by sums.

    Args:
        model: The model.
        x: Its values, in SI.
        found: A run of these, which gives the mean lengths.

    Attributes:
        names: The address of each change, the one of its tuned value.
    """

    def __init__(self, model: Model, x: Any, found: Trajectory) -> None:
        self.names = [free.address for free in model.free]
        self._x = np.array(x)
        self._gains = np.array([not name.endswith(SUMS) and not name.startswith("initial.") for name in self.names])
        self._about = [
            (index, self.names.index(offset), mean)
            for index, name in enumerate(self.names)
            if (offset := name.replace("length_gain", "length_offset")) != name and offset in self.names
            for mean in [_mean_length(model, found, name)]
        ]

    def values(self, changes: Any) -> Any:
        """The values, in SI, after changes of size 1 = a factor of e, or 1 in SI."""
        x = np.where(self._gains, self._x * np.exp(changes), self._x + changes)
        for gain, offset, mean in self._about:
            x[offset] = mean - (mean - x[offset]) * math.exp(-changes[gain])
        return x


def _mean_length(model: Model, found: Trajectory, gain: str) -> float:
    """The mean normalized fiber length while a reflex acts, in l_opt."""
    drives = next(free.drives for free in model.free if free.address == gain)
    reflexes = [drive.rpartition(".")[0] for drive in drives]
    senders = {connection.target: connection.sender for connection in model.connections}
    late = found.times > STEADY
    lengths = [found[senders[f"{reflex}.length"]][late & (found[f"{reflex}.stimulation"] != 0)] for reflex in reflexes]
    return float(np.mean(np.concatenate(lengths)))


def spreads(pool: Pool, changes: Changes, draws: Any) -> Any:
    """Spreads of all changes: LARGEST, or less for one that changes the cost much."""
    count = len(changes.names)
    tried = [np.zeros(count), *(LARGEST / 3 * sign * row for row in np.eye(count) for sign in (1, -1))]
    costs = np.reshape(
        pool.each("cost", [changes.values(each) * share for each in tried for share in draws]), (len(tried), -1)
    )
    risen = np.abs(costs[1:] - costs[0]).mean(axis=1).reshape(count, 2).mean(axis=1)
    return LARGEST * np.minimum(1.0, TOLERATED / np.maximum(risen, 1e-9))


def search(walks: Walks, start: Any, pool: Pool, given: argparse.Namespace) -> Any:
    """The mean center of the last generations of an evolution strategy."""
    first = walks.run(start).trajectory
    assert first is not None
    chance, changes = np.random.default_rng(given.seed), Changes(walks.model, start, first)
    count = len(start)
    spread = given.scale * spreads(pool, changes, 1 + chance.uniform(-SHARE / 2, SHARE / 2, (given.draws, count)))
    weights = np.log(given.population / 2 + 0.5) - np.log(np.arange(1, given.population // 2 + 1))
    centers, end = [np.zeros(count)], time.monotonic() + 60 * given.minutes
    while time.monotonic() < end:
        half = chance.standard_normal((given.population // 2, count))
        steps = np.concatenate([half, -half])
        draws = 1 + chance.uniform(-SHARE, SHARE, (given.draws, count))
        runs = [changes.values(centers[-1] + spread * step) * share for step in steps for share in draws]
        costs = np.reshape(pool.each("cost", runs), (len(steps), -1)).mean(axis=1)
        best = steps[np.argsort(costs)[: len(weights)]]
        centers.append(centers[-1] + spread * (weights @ best) / weights.sum())
        print(f"generation {len(centers) - 1}: lowest {min(costs):.3g}, median {np.median(costs):.3g}", flush=True)
    return np.clip(changes.values(np.mean(centers[-LAST:], axis=0)), walks.low, walks.high)


def main() -> None:
    """Search, and print how the result walks."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spec", type=Path)
    parser.add_argument("minutes", type=float)
    parser.add_argument("--from", dest="start", type=Path, help="values by address in SI; tuned values by default")
    parser.add_argument("--to", type=Path, default=Path("values.json"))
    parser.add_argument("--seconds", type=float, default=12, help="duration of a run")
    parser.add_argument("--step", default="2 ms", help="of a run")
    parser.add_argument("--slowest", type=float, default=1.0, help="speed in m/s below which a walk costs more")
    parser.add_argument("--people", type=float, default=0.0, help="weight of the difference from people")
    parser.add_argument("--draws", type=int, default=6, help="runs of each candidate, with values changed at random")
    parser.add_argument("--scale", type=float, default=0.2, help="of the spreads")
    parser.add_argument("--population", type=int, default=48)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    settings = (f"simulate.step={given.step}", f"simulate.duration={given.seconds:g} s")
    walks = Walks(Opening(given.spec, settings).open().model(), given.slowest, given.people)
    names = [free.address for free in walks.model.free]
    known = json.loads(given.start.read_text()) if given.start else dict(zip(names, walks.model.start, strict=True))
    start = np.array([known[name] for name in names])
    asked = (given.spec, settings, given.slowest, given.people)
    with ProcessPoolExecutor(2, get_context("spawn"), _prepare, asked) as processes:
        pool = Pool(processes)
        found = search(walks, start, pool, given)
        given.to.write_text(json.dumps(dict(zip(names, found.tolist(), strict=True)), indent=0))
        shares = np.random.default_rng(given.seed).uniform(-SHARE, SHARE, (10, len(found)))
        for draw, lasted in enumerate(pool.each("lasts", list(found * (1 + shares)))):
            print(f"draw {draw + 1}: {lasted:.3g} s of {given.seconds:g} s")


if __name__ == "__main__":
    main()
