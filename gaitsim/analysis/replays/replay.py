"""Replays: a model is run once more at one candidate, with every signal."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gaitsim.model import Model, recorded_signals
from gaitsim.simulation.outcome import Outcome, Trajectory
from gaitsim.simulation.run import Mode, Simulator

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Replay:
    """One recorded run.

    Attributes:
        label: Its name in legends.
        path: The spec, or the result folder.
        model: The model, started at the values of the run.
        manifest: The manifest of a result; empty for a spec.
        notices: Notices for the user.
    """

    label: str
    path: Path
    model: Model
    outcome: Outcome
    manifest: Mapping[str, Any] = field(default_factory=dict)
    notices: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The name of the model."""
        return self.model.name

    @property
    def folder(self) -> Path | None:
        """The result folder; None for a spec."""
        return self.path if self.manifest else None

    @property
    def values(self) -> tuple[float, ...]:
        """The candidate: a value for each of `model.free`, in SI."""
        return tuple(self.model.start)

    @property
    def trajectory(self) -> Trajectory:
        """Every signal at every instant, up to a failure. It may be empty."""
        return self.outcome.trajectory or Trajectory(np.zeros(0), (), (), np.zeros((0, 0)))

    @property
    def times(self) -> NDArray[np.float64]:
        """The instants, in s."""
        return self.trajectory.times

    @property
    def ending(self) -> str:
        """How the run ended, in words; empty if it completed."""
        outcome = self.outcome
        if outcome.status == "completed":
            return ""
        stopped = f"stopped by {outcome.ending} after {outcome.simulated_seconds:g} s"
        return stopped if outcome.status == "stopped" else f"failed: {outcome.reason}"

    @property
    def reaches_end(self) -> bool:
        """Whether the last instant of the run is included."""
        last = (self.outcome.steps - 1) * self.outcome.step
        return bool(self.times.size and self.times[-1] > last - 1e-9)

    def between(self, begin: float | None, end: float | None) -> Replay:
        """The same run, restricted to the instants from `begin` to `end` in s."""
        whole = self.trajectory
        low, high = -np.inf if begin is None else begin, np.inf if end is None else end
        inside = (whole.times >= low - 1e-12) & (whole.times <= high + 1e-12)
        part = replace(whole, times=whole.times[inside], values=whole.values[inside])
        return replace(self, outcome=replace(self.outcome, trajectory=part))

    def counted_from(self, begin: float) -> Replay:
        """The same instants with times relative to `begin` in s, so that runs can be drawn over one another."""
        whole = self.trajectory
        return replace(self, outcome=replace(self.outcome, trajectory=replace(whole, times=whole.times - begin)))

    def every(self, interval: float) -> Replay:
        """The same run with fewer instants.

        Args:
            interval: The time between two instants in s; the first instant is kept.

        Raises:
            Usage: Unless that is a whole number of steps.
        """
        return replace(self, outcome=self.outcome.every(interval))


def replayed(
    model: Model,
    path: Path,
    label: str = "",
    manifest: Mapping[str, Any] | None = None,
    notices: Sequence[str] = (),
    mode: Mode = "rapid",
    duration: float | None = None,
    prepared: Callable[[Simulator], None] | None = None,
) -> Replay:
    """Run a model once more from its starts, and record every signal.

    A run that fails is a Replay up to its failure.

    Args:
        model: The model.
        path: The spec or the result folder.
        label: Its name in legends.
        manifest: The manifest of a result.
        notices: Notices for the user.
        mode: Native code ("rapid") or plain Python ("normal").
        duration: In s; that of the model by default.
        prepared: Is called with the simulator before it runs.

    Raises:
        InvalidSpec: The spec breaks a rule.
        InvalidComponent: A component file breaks the contract.
    """
    if duration is not None:
        model = replace(model, simulate=replace(model.simulate, duration=duration))
    simulator = Simulator(model, mode)
    if prepared:
        prepared(simulator)
    outcome = simulator.run(recorded=True)
    return Replay(label or model.name, path, model, outcome, manifest or {}, tuple(notices))


def dataset(replay: Replay) -> xarray.Dataset:
    """The signals of a run as labelled arrays with metadata."""
    from gaitsim.exchange.labelled import labelled

    trajectory = replay.trajectory
    signals = recorded_signals(replay.model) if trajectory.signals else ()
    about = {
        "title": replay.name,
        "source": str(replay.path),
        "gaitsim": str(replay.manifest.get("gaitsim", "")),
        "status": replay.outcome.status,
        "reason": replay.outcome.reason,
        "notices": "\n".join(replay.notices),
        "parameters": ", ".join(f"{free.address} = {free.unit.exactly(free.start)}" for free in replay.model.free),
    }
    return labelled(trajectory, signals, about)
