"""Neighbours of a problem's start: every number a little different, by chance that anyone can repeat."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitsim.optimization.problem import Problem


@dataclass(frozen=True)
class Draws:
    """So many draws: each multiplies every number by 1 + uniform(-within, within), kept inside its bounds.

    Attributes:
        within: A share, 0.01 for 1 %. Draw k, from 1, depends on seed and k only, not on how many there are; a wider
            share moves the same numbers the same way, further.
    """

    count: int
    within: float
    seed: int

    def values(self, problem: Problem) -> list[dict[str, float]]:
        """The numbers of each draw by address, in SI."""
        addresses = [variable.address for variable in problem.variables]
        return [dict(zip(addresses, self._vector(problem, k), strict=True)) for k in range(1, self.count + 1)]

    def _vector(self, problem: Problem, draw: int) -> list[float]:
        start, (low, high) = np.array(problem.start), problem.bounds
        shares = np.random.default_rng([self.seed, draw]).uniform(-1.0, 1.0, start.size)
        return [float(v) for v in np.clip(start * (1 + self.within * shares), low, high)]
