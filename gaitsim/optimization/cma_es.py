"""CMA-ES by pycma."""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np

from gaitsim.optimization.problem import Problem, Vector

_REASONS = {
    "tolfun": "the costs of the last generations hardly differ",
    "tolfunhist": "the best costs of the last generations hardly differ",
    "tolflatfitness": "all candidates have the same cost",
    "tolx": "the steps became too small to matter",
    "tolfacupx": "the steps grew without end; start with a larger spread",
    "tolupsigma": "the steps grew without end",
    "tolxstagnation": "the best candidates hardly move",
    "tolstagnation": "the median cost has stagnated",
    "conditioncov": "the covariance became ill-conditioned",
    "noeffectaxis": "steps along an axis have no effect any more",
    "noeffectcoord": "steps in a coordinate have no effect any more",
}


@contextmanager
def _absent(*modules: str) -> Iterator[None]:
    """Make modules impossible to import within the block. pycma imports them without need, which takes a second."""
    before = {name: sys.modules[name] for name in modules if name in sys.modules}
    sys.modules.update(dict.fromkeys(modules))  # type: ignore[arg-type]
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        for name in modules:
            del sys.modules[name]
        sys.modules.update(before)


class CmaEs:
    """CMA-ES by pycma, with a random stream of its own."""

    def __init__(self, problem: Problem, seed: int, population: int | None) -> None:
        with _absent("matplotlib", "scipy.stats"):
            import cma

        stream = np.random.default_rng([seed, 0])
        low, high = problem.bounds
        options: dict[str, Any] = {
            "bounds": [problem.scaled(list(low)), problem.scaled(list(high))],
            "randn": lambda *shape: stream.standard_normal(shape),
            "seed": math.nan,
            "verbose": -9,
            "verb_log": 0,
            "verb_disp": 0,
            "signals_filename": None,
            "maxiter": math.inf,
        }
        if len(problem.variables) == 1:
            options["maxstd"] = math.inf  # pycma 4 cannot limit the spread of a single number
        if population is not None:
            options["popsize"] = population
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self._strategy = cma.CMAEvolutionStrategy(problem.scaled(problem.start), 1.0, options)

    @property
    def population(self) -> int:
        return int(self._strategy.popsize)

    def ask(self) -> list[Vector]:
        asked: list[Vector] = self._strategy.ask()
        return asked

    def tell(self, vectors: Sequence[Vector], costs: Sequence[float]) -> None:
        self._strategy.tell(list(vectors), list(costs))

    def stop(self) -> str | None:
        found = self._strategy.stop()
        reasons = dict.fromkeys(_REASONS.get(name, name) for name in found)
        return "; ".join(reasons) or None
