"""What a run yields: metrics, score, status; and a trajectory only when asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


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
    """The result of one simulation. Status: completed, stopped (by a measure) or failed."""

    status: str
    reason: str
    steps: int
    step: float
    metrics: Mapping[str, float]
    score: float | None
    wall_seconds: float
    trajectory: Trajectory | None = field(default=None, repr=False)

    @property
    def simulated_seconds(self) -> float:
        return self.steps * self.step
