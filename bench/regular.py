"""Search for a robust walk in space: `python bench/regular.py SPEC MINUTES --to values.json`.

The time until a fall says little while all candidates fall. How far touchdowns differ from one another says more: the
cost of a run is the mean square of six deviations from their medians over its touchdowns. They are roll and pitch of
the pelvis, lateral velocity of the center of mass and its distance to the side of the new foot, both relative to the
heading, duration of the step, and speed; signs are mirrored on the left. A touchdown that a fall prevents costs 9.

A robust walk bears changes of its values, and random changes make a cost that is mostly noise. The search therefore
finds the directions in which small changes of all values move the first steps most (a singular value decomposition of
central differences). It runs each candidate as it is and changed along these directions, to both sides, as far as
random changes of up to 1 % reach in `--deviations` standard deviations. CMA-ES minimizes the mean. It writes the mean
of its distribution, and prints how long that walks if all values are changed at random by up to 1 %.
"""

from __future__ import annotations

import argparse
import json
import math
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cma
import numpy as np
from touchdowns import SCALES, touchdowns

from gaitsim.model import Model
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

MOST = 9.0  # cost of a touchdown that differs much, or is missing
SETTLED = 2  # touchdowns before the first that counts
USUAL = 0.56  # s: between touchdowns
SHARE = 0.01  # largest relative change of a value
DIFFERENCE = 0.002  # of values, relative, for central differences
COMPARED = slice(1, 8)  # touchdowns whose differences tell the directions
AGAIN = 16  # generations until the directions are determined again


@dataclass
class Walks:
    """Runs of one model.

    Attributes:
        model: The model.
        slowest: Speed in m/s below which a walk costs more.
    """

    model: Model
    slowest: float = 1.0

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
        return float((each.sum() + MOST * missing) / (len(rows) + missing) + 10 * slow)

    def first_steps(self, x: Any) -> Any:
        """The first touchdowns in units of their scales; none if the walker falls before."""
        rows = self._rows(self.run(x))[COMPARED]
        return (rows / SCALES).ravel() if len(rows) == COMPARED.stop - COMPARED.start else None

    def lasts(self, x: Any) -> float:
        """How long a candidate stays up, in s."""
        return self.run(x).simulated_seconds

    def _rows(self, outcome: Outcome) -> Any:
        found = outcome.trajectory
        return touchdowns(found) if found is not None and len(found.times) > 1 else np.zeros((0, 6))


_WALKS: list[Walks] = []  # of this process


def _prepare(spec: Path, settings: tuple[str, ...], slowest: float) -> None:
    _WALKS[:] = [Walks(Opening(spec, settings).open().model(), slowest)]


def _called(method: str, x: Any) -> Any:
    return getattr(_WALKS[0], method)(x)


@dataclass
class Pool:
    """Calls methods of `Walks` in two processes."""

    processes: ProcessPoolExecutor

    def each(self, method: str, candidates: list[Any]) -> list[Any]:
        """The results of a method for some candidates."""
        return list(self.processes.map(_called, [method] * len(candidates), candidates, chunksize=4))


def directions(pool: Pool, x: Any, count: int) -> Any:
    """Relative changes of all values, of size 1, that move the first steps most; a row for each."""
    ends = [x * (1 + sign * DIFFERENCE * row) for row in np.eye(len(x)) for sign in (1, -1)]
    steps = pool.each("first_steps", ends)
    slopes = np.zeros((len(SCALES) * (COMPARED.stop - COMPARED.start), len(x)))
    for i, (after, before) in enumerate(zip(steps[::2], steps[1::2], strict=True)):
        if after is not None and before is not None:
            slopes[:, i] = np.nan_to_num(after - before)
    return np.linalg.svd(slopes, full_matrices=False)[2][:count]


def search(walks: Walks, start: Any, pool: Pool, given: argparse.Namespace) -> Any:
    """The mean of CMA-ES after some time."""
    spreads = [given.scale * free.spread for free in walks.model.free]
    bounds = [walks.low.tolist(), walks.high.tolist()]
    options = {"popsize": given.population, "CMA_stds": spreads, "bounds": bounds, "seed": given.seed, "verbose": -9}
    found = cma.CMAEvolutionStrategy(np.clip(start, walks.low, walks.high), 1.0, options)
    far = given.deviations * SHARE / math.sqrt(3)  # the standard deviation of a uniform distribution
    center, end, generation = start, time.monotonic() + 60 * given.minutes, 0
    while time.monotonic() < end:
        if generation % AGAIN == 0:
            most = directions(pool, center, given.directions)
            changes = [np.zeros(len(start)), *(far * most), *(-far * most)]
        generation += 1
        candidates = found.ask()
        runs = [np.array(x) * (1 + change) for x in candidates for change in changes]
        costs = np.reshape(pool.each("cost", runs), (len(candidates), -1)).mean(axis=1)
        found.tell(candidates, costs.tolist())
        center = np.clip(found.result.xfavorite, walks.low, walks.high)
        print(f"generation {generation}: lowest {min(costs):.3g}, median {np.median(costs):.3g}", flush=True)
    return center


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
    parser.add_argument("--directions", type=int, default=3, help="directions in which each candidate is changed")
    parser.add_argument("--deviations", type=float, default=1.5, help="how far, in standard deviations")
    parser.add_argument("--scale", type=float, default=0.1, help="spreads of the search, in those of the spec")
    parser.add_argument("--population", type=int, default=24)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    settings = (f"simulate.step={given.step}", f"simulate.duration={given.seconds:g} s")
    walks = Walks(Opening(given.spec, settings).open().model(), given.slowest)
    names = [free.address for free in walks.model.free]
    known = json.loads(given.start.read_text()) if given.start else dict(zip(names, walks.model.start, strict=True))
    start = np.array([known[name] for name in names])
    with ProcessPoolExecutor(2, initializer=_prepare, initargs=(given.spec, settings, given.slowest)) as processes:
        pool = Pool(processes)
        found = search(walks, start, pool, given)
        given.to.write_text(json.dumps(dict(zip(names, found.tolist(), strict=True)), indent=0))
        shares = np.random.default_rng(given.seed).uniform(-SHARE, SHARE, (10, len(found)))
        for draw, lasted in enumerate(pool.each("lasts", list(found * (1 + shares)))):
            print(f"draw {draw + 1}: {lasted:.3g} s of {given.seconds:g} s")


if __name__ == "__main__":
    main()
