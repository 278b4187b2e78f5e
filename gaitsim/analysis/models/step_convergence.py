"""Convergence over the step: every metric at the step of a spec, a half and a quarter of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from gaitsim.model import Model
from gaitsim.simulation.batch import run_all
from gaitsim.simulation.outcome import Outcome

PARTS = (1, 2, 4)  # of the step


@dataclass(frozen=True)
class Change:
    """One metric at the step, a half and a quarter; None where the run failed or had no value."""

    name: str
    unit: str
    values: tuple[float | None, ...]

    @property
    def relative(self) -> float | None:
        """The difference between the step and the quarter, relative to the largest of the three values."""
        if any(value is None for value in self.values):
            return None
        known = [value for value in self.values if value is not None]
        scale = max(map(abs, known))
        return abs(known[0] - known[-1]) / scale if scale else 0.0

    @property
    def ratio(self) -> float | None:
        """The ratio of the changes of the first and the second halving: 2 for first order, 4 for second."""
        first, second, third = self.values
        if first is None or second is None or third is None or third == second:
            return None
        return (second - first) / (third - second)

    @property
    def order(self) -> float | None:
        """The observed order of convergence; None where the changes do not decrease in one direction."""
        ratio = self.ratio
        return math.log2(ratio) if ratio is not None and ratio > 0 else None

    def flag(self, tolerance: float) -> str:
        """The remark about the change; empty if it is within the tolerance."""
        relative = self.relative
        if relative is None:
            return "no value"
        return f"changes by {100 * relative:.3g} %" if relative > tolerance else ""


@dataclass(frozen=True)
class StepConvergence:
    """The three steps in seconds, their outcomes, and the changes of all metrics."""

    steps: tuple[float, ...]
    outcomes: tuple[Outcome, ...]
    changes: tuple[Change, ...]


def step_convergence(model: Model) -> StepConvergence:
    """Run a model three times with decreasing steps, in parallel."""
    steps = tuple(model.simulate.step / n for n in PARTS)
    models = [replace(model, simulate=replace(model.simulate, step=step)) for step in steps]
    outcomes = tuple(run_all(models, "rapid"))
    changes = [
        Change(name, unit, tuple(_finite(outcome.metrics.get(name)) for outcome in outcomes))
        for name, unit in model.metrics.items()
    ]
    if model.objective is not None:
        changes.append(Change("score", "1", tuple(_finite(outcome.score) for outcome in outcomes)))
    return StepConvergence(steps, outcomes, tuple(changes))


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
