"""Draws around the start of a problem: every number is changed a little, by reproducible random numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gaitsim.optimization.problem import Problem


@dataclass(frozen=True)
class Draws:
    """Random draws. Each multiplies every number by 1 + uniform(-within, within) and keeps it within its bounds.

    Draw k, from 1, depends on seed and k only. A larger share moves the same numbers in the same direction, further.

    Attributes:
        within: The largest relative change: 0.01 for 1 %.
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
