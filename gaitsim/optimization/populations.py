"""GA, PSO and DE by pymoo. They need an extra: pip install 'gaitsim[populations]'."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Any

import numpy as np

from gaitsim.optimization.problem import Problem, Vector

_POPULATION = 40


class Pymoo:
    """One of pymoo's algorithms, with the same start and spread as CMA-ES."""

    def __init__(self, kind: str, problem: Problem, seed: int, population: int | None) -> None:
        from pymoo.core.problem import Problem as Bounds
        from pymoo.core.termination import NoTermination

        self.population = _POPULATION if population is None else population
        low, high = (problem.scaled(list(bound)) for bound in problem.bounds)
        stream = np.random.default_rng([seed, 0])
        spread = stream.standard_normal((self.population, len(low)))
        first = np.clip(problem.scaled(problem.start) + spread, low, high)
        made = getattr(import_module(f"pymoo.algorithms.soo.nonconvex.{kind.lower()}"), kind)
        self._algorithm = made(pop_size=self.population, sampling=first)
        bounds = Bounds(n_var=len(low), n_obj=1, xl=low, xu=high)
        self._algorithm.setup(bounds, termination=NoTermination(), seed=seed, verbose=False)
        self._asked: Any = None

    def ask(self) -> list[Vector]:
        self._asked = self._algorithm.ask()
        return list(np.asarray(self._asked.get("X"), dtype=np.float64))

    def tell(self, vectors: Sequence[Vector], costs: Sequence[float]) -> None:  # noqa: ARG002 (it wants its own objects back)
        self._asked.set("F", np.array(costs, dtype=np.float64)[:, None])
        self._algorithm.tell(infills=self._asked)

    def stop(self) -> str | None:
        """None: these algorithms end with the last generation only."""
        return None
