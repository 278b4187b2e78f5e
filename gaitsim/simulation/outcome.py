"""What a run yields: metrics, score, status; and a trajectory only when asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from gaitsim.errors import Usage


@dataclass(frozen=True)
class Trajectory:
    """Outputs and states of all parts (`model.recorded_signals`) at every instant: values (instants x signals)."""

    times: NDArray[np.float64]
    signals: tuple[str, ...]
    units: tuple[str, ...]
    values: NDArray[np.float64]

    def __getitem__(self, signal: str) -> NDArray[np.float64]:
        return self.values[:, self.signals.index(signal)]


@dataclass(frozen=True)
class Outcome:
    """The result of one simulation. Status: completed, stopped (by a measure) or failed.

    Attributes:
        level: What the measure that stopped it says of the end, if it has a state with named levels: fell_to_the_right.
    """

    status: str
    reason: str
    steps: int
    step: float
    metrics: Mapping[str, float]
    score: float | None
    wall_seconds: float
    trajectory: Trajectory | None = field(default=None, repr=False)
    level: str = ""

    @property
    def ending(self) -> str:
        """Who stopped it, and what that says of it, in words: fall_time, fell to the right."""
        return f"{self.reason}, {self.level.replace('_', ' ')}" if self.level else self.reason

    @property
    def simulated_seconds(self) -> float:
        return self.steps * self.step

    def every(self, interval: float) -> Outcome:
        """The same run, of whose trajectory one instant in `interval` seconds is kept, the first included.

        Raises:
            Usage: Unless that is a whole number of steps.
        """
        whole, steps = self.trajectory, steps_in(interval, self.step)
        if whole is None:
            return self
        part = replace(whole, times=whole.times[::steps], values=whole.values[::steps])
        return replace(self, trajectory=part)


def steps_in(interval: float, step: float) -> int:
    """How many steps an interval has, both in s.

    Raises:
        Usage: Unless that is a whole number.
    """
    steps = round(interval / step)
    if steps < 1 or abs(steps * step - interval) > 1e-9:
        raise Usage(f"one instant every {interval:g} s: the run has steps of {step:g} s; write a multiple of that.")
    return steps
