"""Search for a walk in space with equal steps: `python bench/regular.py SPEC MINUTES --to values.json`.

The time until a fall says little while all candidates fall. How far touchdowns differ from one another says more, and a
candidate that was changed at random says whether deviations decay. The cost is the mean square of seven deviations from
their medians over the touchdowns of a run: yaw, roll and pitch of the pelvis, lateral velocity of the center of mass,
its distance to the side of the new foot, duration of the step, and speed; signs are mirrored on the left. A touchdown
that a fall prevents costs 9. CMA-ES with a diagonal covariance evaluates each candidate once, changed at random, and
writes the mean of its distribution. With `--descend`, central differences give the slope of the mean cost of some
random changes, and the values move against it; a step takes longer and brings more. A table says how the result walks
if it is changed by up to 1 %.
"""

from __future__ import annotations

import argparse
import json
import time
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
USUAL = 0.56  # s: between two touchdowns
SLOWEST, FASTEST = 1.0, 1.45  # m/s
# Of the slope: differences to either side and lengths of a step, in spreads of the spec.
DIFFERENCE, LENGTHS = 0.06, (0.003, 0.01, 0.03, 0.1)


def cost(outcome: Outcome, duration: float) -> float:
    """How far the steps of a walk differ, and its speed from people's."""
    assert outcome.trajectory is not None
    rows = touchdowns(outcome.trajectory) if len(outcome.trajectory.times) > 1 else np.zeros((0, 7))
    if len(rows) <= SETTLED + 1:
        return MOST * (2 - outcome.simulated_seconds / duration)
    wanted = int(duration / USUAL)
    rows = rows[SETTLED:wanted]
    each = np.minimum(MOST, np.mean(((rows - np.median(rows, axis=0)) / SCALES) ** 2, axis=1))
    missing = max(0, wanted - SETTLED - len(rows)) if outcome.status != "completed" else 0
    speed = float(np.median(rows[:, 6]))
    wrong = max(0.0, SLOWEST - speed, speed - FASTEST)
    return float((each.sum() + MOST * missing) / (len(rows) + missing) + 10 * wrong)


@dataclass
class Walks:
    """Runs of one model at values that are changed at random by up to a share."""

    model: Model
    share: float

    def __post_init__(self) -> None:
        self.simulator = Simulator(self.model)
        self.low, self.high = (np.array([getattr(free, end) for free in self.model.free]) for end in ("low", "high"))

    def run(self, x: Any, seed: list[int], share: float | None = None) -> Outcome:
        """Run a candidate, within the bounds."""
        within = self.share if share is None else share
        changed = x * (1 + within * np.random.default_rng(seed).uniform(-1, 1, len(x)))
        return self.simulator.run(np.clip(changed, self.low, self.high).tolist(), recorded=True)

    def mean_cost(self, x: Any, seeds: list[list[int]]) -> float:
        """The mean cost of several random changes."""
        return float(np.mean([self.cost(x, seed) for seed in seeds]))

    def cost(self, x: Any, seed: list[int]) -> float:
        """The cost of one run, and of values beyond the bounds."""
        beyond = (x - np.clip(x, self.low, self.high)) / np.array([free.spread for free in self.model.free])
        return cost(self.run(x, seed), self.model.simulate.duration) + 10 * float(beyond @ beyond)


def search(walks: Walks, start: Any, minutes: float, scale: float, population: int) -> Any:
    """The mean of CMA-ES after some time."""
    spreads = [scale * free.spread for free in walks.model.free]
    options = {"popsize": population, "CMA_stds": spreads, "CMA_diagonal": True, "seed": 1, "verbose": -9}
    found = cma.CMAEvolutionStrategy(start, 1.0, options)
    end, generation = time.monotonic() + 60 * minutes, 0
    while time.monotonic() < end:
        generation += 1
        candidates = found.ask()
        costs = [walks.cost(np.array(x), [generation, k]) for k, x in enumerate(candidates)]
        found.tell(candidates, costs)
        if generation % 10 == 0:
            print(f"generation {generation}: lowest {min(costs):.3g}, median {np.median(costs):.3g}", flush=True)
    return np.clip(found.mean, walks.low, walks.high)


def descend(walks: Walks, start: Any, minutes: float, draws: int) -> Any:
    """The values that are reached against the slope of the mean cost of some draws, which are new in each iteration."""
    spreads = np.array([free.spread for free in walks.model.free])
    end, x, iteration = time.monotonic() + 60 * minutes, np.array(start), 0
    while time.monotonic() < end:
        iteration += 1
        seeds = [[iteration, draw] for draw in range(draws)]
        before = walks.mean_cost(x, seeds)
        slope = np.zeros(len(x))
        for i, move in enumerate(np.diag(DIFFERENCE * spreads)):
            slope[i] = walks.mean_cost(x + move, seeds) - walks.mean_cost(x - move, seeds)
        way = -slope * spreads * np.sqrt(len(x)) / max(float(np.linalg.norm(slope)), 1e-12)
        tried = [np.clip(x + length * way, walks.low, walks.high) for length in (0, *LENGTHS)]
        costs = [walks.mean_cost(each, seeds) for each in tried]
        x = tried[int(np.argmin(costs))]
        print(f"iteration {iteration}: {before:.3g}, then {min(costs):.3g}", flush=True)
    return x


def main() -> None:
    """Search, and print how the result walks."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spec", type=Path)
    parser.add_argument("minutes", type=float)
    parser.add_argument("--from", dest="start", type=Path, help="values by address in SI; tuned values by default")
    parser.add_argument("--to", type=Path, default=Path("values.json"))
    parser.add_argument("--seconds", type=float, default=9)
    parser.add_argument("--step", default="2 ms")
    parser.add_argument("--share", type=float, default=0.004)
    parser.add_argument("--scale", type=float, default=0.2, help="spreads of the search, in those of the spec")
    parser.add_argument("--population", type=int, default=40)
    parser.add_argument("--descend", type=int, metavar="DRAWS", help="descend on the mean of so many draws")
    given = parser.parse_args()
    settings = (f"simulate.step={given.step}", f"simulate.duration={given.seconds:g} s")
    walks = Walks(Opening(given.spec, settings).open().model(), given.share)
    names = [free.address for free in walks.model.free]
    known = json.loads(given.start.read_text()) if given.start else dict(zip(names, walks.model.start, strict=True))
    start = np.array([known[name] for name in names])
    if given.descend:
        found = descend(walks, start, given.minutes, given.descend)
    else:
        found = search(walks, start, given.minutes, given.scale, given.population)
    given.to.write_text(json.dumps(dict(zip(names, found.tolist(), strict=True)), indent=0))
    for draw in range(10):
        ended = walks.run(found, [0, draw], 0.01)
        print(f"draw {draw + 1}: {ended.status} after {ended.simulated_seconds:.3g} s")


if __name__ == "__main__":
    main()
