"""The result of a run: metrics, score and status, and a trajectory if one was asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from gaitsim.errors import Usage


@dataclass(frozen=True)
class Trajectory:
    """Outputs and states of all parts (`model.recorded_signals`) at every instant, in SI: an array of instants x
    signals.
    """

    times: NDArray[np.float64]
    signals: tuple[str, ...]
    units: tuple[str, ...]
    values: NDArray[np.float64]

    def __getitem__(self, signal: str) -> NDArray[np.float64]:
        return self.values[:, self.signals.index(signal)]


@dataclass(frozen=True)
class Outcome:
    """The result of one simulation. Its status is completed, stopped (by a measure) or failed.

    Attributes:
        level: The final state of the measure that stopped it, if that has named levels, such as fell_to_the_right.
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
        """The measure that stopped the run, and its final state in words: fall_time, fell to the right."""
        return f"{self.reason}, {self.level.replace('_', ' ')}" if self.level else self.reason

    @property
    def simulated_seconds(self) -> float:
        return self.steps * self.step

    def every(self, interval: float) -> Outcome:
        """The same run with a thinned trajectory.

        Args:
            interval: The time between two instants that are kept, in s. The first instant is kept.

        Raises:
            Usage: The interval is not a whole number of steps.
        """
        whole, steps = self.trajectory, steps_in(interval, self.step)
        if whole is None:
            return self
        part = replace(whole, times=whole.times[::steps], values=whole.values[::steps])
        return replace(self, trajectory=part)


def steps_in(interval: float, step: float) -> int:
    """The number of steps in an interval.

    Args:
        interval: In s.
        step: In s.

    Raises:
        Usage: The interval is not a whole number of steps.
    """
    steps = round(interval / step)
    if steps < 1 or abs(steps * step - interval) > 1e-9:
        raise Usage(f"one instant every {interval:g} s: the time step is {step:g} s; write a multiple of it.")
    return steps
