"""Robust tuning: `python bench/robust.py SPEC` searches with draws in the objective.

The cost of a candidate is the mean of its own and those of `--draws` neighbours, whose tuned values all differ from its
own by up to `--within`. Each generation has new neighbours, the same for all of its candidates. It starts at the tuned
values of the spec and writes what it found beside it; `gaitsim optimize SPEC --from tuned --adopt --force` then runs
these values and records them. `--set` overrides values of the spec, as for gaitsim.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import cma
import numpy as np
from numpy.typing import NDArray

from gaitsim.model import Model
from gaitsim.results.tuned import tuned_path
from gaitsim.simulation.run import Simulator
from gaitsim.study.opening import Opening

Vector = NDArray[np.float64]
WORST = 300.0  # cost of a candidate that has none


class Robust:
    """Mean cost of a vector and its neighbours, in values divided by their spreads."""

    def __init__(self, model: Model, draws: int, within: float, seed: int) -> None:
        self.spreads = np.array([free.spread for free in model.free])
        self.low, self.high = (np.array([getattr(free, end) for free in model.free]) for end in ("low", "high"))
        self.start = np.array(model.start) / self.spreads
        self._simulator, self._chance = Simulator(model), np.random.default_rng(seed)
        self._count, self._within = draws, within
        self._shares: Vector = np.ones((1, self.start.size))

    def renew(self) -> None:
        """Other neighbours, for the next generation."""
        shares = self._chance.uniform(-self._within, self._within, (self._count, self.start.size))
        self._shares = 1 + np.concatenate([np.zeros((1, self.start.size)), shares])

    def values(self, scaled: Vector, share: Vector | float = 1.0) -> Vector:
        """Values in SI, within their bounds."""
        found: Vector = np.clip(scaled * self.spreads * share, self.low, self.high)
        return found

    def cost(self, scaled: Vector) -> float:
        """The mean over the vector and its neighbours."""
        scores = [self._simulator.run(list(self.values(scaled, share))).score for share in self._shares]
        return float(np.mean([WORST if score is None or not np.isfinite(score) else score for score in scores]))


def written(model: Model, values: Vector, score: float) -> str:
    """The text of a file of tuned values."""
    pairs = [
        f"{free.address}: {value!r}" + (f" {free.unit.si}" if free.unit.si != "1" else "")
        for free, value in zip(model.free, map(float, values), strict=True)
    ]
    head = "about: Written by bench/robust.py; not by hand.\nformat: 2\nresult: none, from bench/robust.py\n"
    return f"{head}score: {score!r}\nvalues: {{{', '.join(pairs)}}}\n"


def main() -> None:
    """Search, and write the center of the last generation."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("spec", type=Path)
    parser.add_argument("--draws", type=int, default=5, help="neighbours of each candidate")
    parser.add_argument("--within", type=float, default=0.01, help="largest relative change of a value")
    parser.add_argument("--generations", type=int, default=50, help="of the search")
    parser.add_argument("--population", type=int, default=16, help="candidates of a generation")
    parser.add_argument("--spread-factor", type=float, default=0.1, help="on the spreads of the spec")
    parser.add_argument("--seed", type=int, default=1, help="of the search and of the draws")
    parser.add_argument("--set", action="append", default=[], help="ADDRESS=VALUE; repeatable")
    options = parser.parse_args()
    model = Opening(options.spec, tuple(options.set)).open().model()
    robust = Robust(model, options.draws, options.within, options.seed)
    bounds = [list(robust.low / robust.spreads), list(robust.high / robust.spreads)]
    settings = {"bounds": bounds, "popsize": options.population, "seed": options.seed, "verbose": -9}
    search = cma.CMAEvolutionStrategy(robust.start, options.spread_factor, settings)
    for generation in range(options.generations):
        robust.renew()
        candidates = search.ask()
        costs = [robust.cost(candidate) for candidate in candidates]
        search.tell(candidates, costs)
        print(f"generation {generation + 1}: least {min(costs):.2f}, median {np.median(costs):.2f}", flush=True)
        center = np.asarray(search.result.xfavorite)
        text = written(model, robust.values(center), robust.cost(center))
        tuned_path(options.spec).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
