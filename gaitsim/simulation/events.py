"""Steps with events in plain Python: Runge-Kutta steps of order 4, divided where an output `guard` rises through 0.

The parts compute their forces in every stage, with their states of this step. If a guard is below 0 at the beginning of
a step and not below 0 at its end, there is an event between. The step is then repeated from its beginning, and its
length is halved until the event is located. `reset` changes states, and the ports tied by `mj.reset` change
coordinates; then the rest of the step follows. `compiler/events.py` does the same in native code.
"""

from __future__ import annotations

from typing import Any, Protocol

import mujoco
import numpy as np

from gaitsim.compiler.mjcf import AFTER_VELOCITIES, tie_place
from gaitsim.compiler.native import EVENTS, HALVINGS, RUNGE_KUTTA
from gaitsim.compiler.program import Floats, Program
from gaitsim.components.checks.check import GUARD
from gaitsim.simulation.failure import of_events
from gaitsim.simulation.physics import Physics


class Failed(Exception):
    """A component failed. The text says which and why."""


class Run(Protocol):
    """What steps with events need of a run; each method may raise `Failed`."""

    program: Program
    physics: Physics
    dt: float

    def look(self, step: int) -> None:
        """Compute all outputs at the present positions and velocities of MuJoCo."""

    def apply(self, step: int) -> None:
        """Write forces and controls to MuJoCo."""

    def gather(self, part: int, step: int) -> None:
        """Sum the senders of a part's inputs."""

    def call(self, part: int, stage: str, step: int, check: bool = True, time: float | None = None) -> None:
        """Call one function of a part."""

    def sent(self, part: int, port: str) -> Any:
        """The value of an output of a part, or of an input."""


def advance(run: Run, step: int) -> None:
    """Advance the mechanics by one step.

    Args:
        run: The run.
        step: The index of the step.

    Raises:
        Failed: A component fails.
    """
    done, data = 0.0, run.physics.data
    risen: list[int] = []
    for _ in range(EVENTS):
        begin = data.qpos.copy(), data.qvel.copy()
        before = _guards(run)
        run.look(step)
        risen = _risen(run, before)  # by what states have become, in an update or a reset
        if not risen:
            before = _guards(run)
            low, high = 0.0, run.dt - done
            _move(run, step, begin, high)
            if not _risen(run, before):
                return
            for _ in range(HALVINGS):
                middle = low + 0.5 * (high - low)
                _move(run, step, begin, middle)
                low, high = (low, middle) if _risen(run, before) else (middle, high)
            _move(run, step, begin, high)
            done = done + high
            risen = _risen(run, before)
        _reset(run, step, risen, step * run.dt + done)
    raise Failed(of_events(run.program, risen, step))


def _move(run: Run, step: int, begin: tuple[Floats, Floats], span: float) -> None:
    """Move from the coordinates and rates at the beginning on for a time, and compute all outputs there."""
    model, data = run.physics.model, run.physics.data
    position, speed = begin
    # Not 0: adding a rate of -0 would lose the sign, which native code keeps.
    velocities, accelerations = np.full_like(position, -0.0), np.full_like(speed, -0.0)
    data.qpos[:], data.qvel[:] = begin
    for stage, (share, weight) in enumerate(RUNGE_KUTTA):
        if stage:
            shift = share * span
            data.qpos[:], data.qvel[:] = position + shift * data.qvel, speed + shift * data.qacc
        run.look(step)
        run.apply(step)
        mujoco.mj_forwardSkip(model, data, AFTER_VELOCITIES, 0)
        velocities += weight * data.qvel
        accelerations += weight * data.qacc
    sixth = span / 6.0
    data.qpos[:], data.qvel[:] = position + sixth * velocities, speed + sixth * accelerations
    run.look(step)


def _guards(run: Run) -> list[float]:
    return [float(run.sent(part, GUARD)) for part in run.program.guarded]


def _risen(run: Run, before: list[float]) -> list[int]:
    """The parts whose guards rose through 0."""
    guards = zip(run.program.guarded, before, _guards(run), strict=True)
    return [part for part, earlier, now in guards if earlier < 0 <= now]


def _reset(run: Run, step: int, parts: list[int], time: float) -> None:
    """Apply the events of an instant: coordinates, and states of their parts."""
    physics = run.physics
    for part in {part for part, _ in physics.assembly.resets}:
        run.gather(part, step)
    sent: list[tuple[Any, Any]] = [
        (run.sent(part, tie.port), run.sent(part, tie.when)) for part, tie in physics.assembly.resets
    ]
    for (_, tie), (value, when) in zip(physics.assembly.resets, sent, strict=True):
        if when > 0.5:
            physics.array(tie.field)[tie_place(physics.model, tie)] = value
    for part in parts:
        run.gather(part, step)
        run.call(part, "reset", step, time=time)
