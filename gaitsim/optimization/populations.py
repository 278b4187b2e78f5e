"""GA, PSO and DE by pymoo, behind ask and tell; an extra: pip install 'gaitsim[populations]'."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from gaitsim.errors import Usage
from gaitsim.optimization.problem import Problem, Vector

_POPULATION = 40


class Pymoo:
    """One of pymoo's algorithms, with the start and spread that CMA-ES would have."""

    def __init__(self, name: str, problem: Problem, seed: int, population: int | None) -> None:
        try:
            from pymoo.core.problem import Problem as Bounds
            from pymoo.core.termination import NoTermination
        except ImportError as error:
            rule = f"--algorithm {name}: needs pymoo, which is not installed"
            raise Usage(f"{rule}; install it: pip install 'gaitsim[populations]'.") from error
        self.population = _POPULATION if population is None else population
        low, high = (problem.scaled(list(bound)) for bound in problem.bounds)
        stream = np.random.default_rng([seed, 0])
        spread = stream.standard_normal((self.population, len(low)))
        first = np.clip(problem.scaled(problem.start) + spread, low, high)
        self._algorithm = _made(name, self.population, first)
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
        """Only the budget ends these."""
        return None

    def distribution(self) -> tuple[Vector, Vector] | None:
        found = self._algorithm.pop
        if found is None or len(found) == 0:
            return None
        places = np.asarray(found.get("X"), dtype=np.float64)
        return places[int(np.argmin(found.get("F")[:, 0]))], places.std(axis=0)


def _made(name: str, population: int, first: Any) -> Any:
    from pymoo.algorithms.soo.nonconvex.de import DE
    from pymoo.algorithms.soo.nonconvex.ga import GA
    from pymoo.algorithms.soo.nonconvex.pso import PSO

    kinds: dict[str, Callable[..., Any]] = {"ga": GA, "pso": PSO, "de": DE}
    return kinds[name](pop_size=population, sampling=first)
