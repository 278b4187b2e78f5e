"""The cost of a step of a model, part by part, and stage by stage within MuJoCo."""

from __future__ import annotations

import ctypes
import statistics
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import mujoco
import numpy as np

from gaitsim.compiler import machine
from gaitsim.compiler.native import CLOCK, TICKS, TIMED
from gaitsim.compiler.plan import plan_of
from gaitsim.compiler.program import Program
from gaitsim.errors import SimulationFailed
from gaitsim.model import Model
from gaitsim.simulation.native_loop import NativeLoop

PAIRS = 5
LOOP = "delays, checks, loop"
OWN = "paths, contacts, sum of forces"
OTHER = "other mechanics"
# MuJoCo's timers that do not contain one another, by stage.
_TIMERS = {
    "kinematics": "POS_KINEMATICS",
    "inertia": "POS_INERTIA",
    "collision": "POS_COLLISION",
    "constraints": "POS_MAKE",
    "projection": "POS_PROJECT",
    "velocity": "VELOCITY",
    "actuation": "ACTUATION",
    "solver": "CONSTRAINT",
    "integration": "ADVANCE",
}


@dataclass(frozen=True)
class Cost:
    """What a part, or a stage of MuJoCo, takes of each step: the number of calls, and the time of all of them in s."""

    name: str
    use: str
    calls: int
    seconds: float


@dataclass(frozen=True)
class Profile:
    """The costs of a step, largest first.

    Attributes:
        step: The time of a step without the stopwatch, in s.
        slower: The factor by which the stopwatch slows the step.
    """

    costs: tuple[Cost, ...]
    step: float
    slower: float
    steps: int

    @property
    def measured(self) -> float:
        """The sum of all costs, in s."""
        return sum(cost.seconds for cost in self.costs)

    def by_component(self) -> tuple[Cost, ...]:
        """The costs, added over the parts of each component."""
        found: dict[str, Cost] = {}
        for cost in self.costs:
            key = cost.name if cost.use in ("MuJoCo", "") else cost.use
            before = found.get(key, Cost(key, cost.use, 0, 0.0))
            found[key] = Cost(key, cost.use, before.calls + cost.calls, before.seconds + cost.seconds)
        return _sorted(found.values())


def profile(model: Model) -> Profile:
    """Run a model several times, alternately with and without the stopwatch.

    Raises:
        SimulationFailed: The run fails.
        InvalidSpec: The model cannot be prepared.
        InvalidComponent: A component cannot become native code.
    """
    plain, timed = NativeLoop(Program(model)), NativeLoop(Program(model), timed=True)
    for each in (plain, timed):
        each.prepare()
    watch = _Watch(timed, model)
    watch.run()  # the first runs warm both up
    _run(plain, model)
    pairs = [(_step(plain, model), watch.run()) for _ in range(PAIRS)]
    step = statistics.median(seconds for seconds, _ in pairs)
    slower = statistics.median(timed.step / seconds for seconds, timed in pairs)
    costs = [
        Cost(cost.name, cost.use, cost.calls, statistics.median(each.costs[i].seconds for _, each in pairs))
        for i, cost in enumerate(pairs[0][1].costs)
    ]
    return Profile(_sorted(costs), step, slower, watch.steps)


@dataclass(frozen=True)
class _Timed:
    """One run with the stopwatch: the time of a step in s, and the times of its parts."""

    step: float
    costs: tuple[Cost, ...]


class _Watch:
    """Runs a model with the stopwatch in its native code."""

    def __init__(self, loop: NativeLoop, model: Model) -> None:
        self.loop, self.model, self.steps = loop, model, 0
        self.parts = len(plan_of(loop.program, loop.physics.assembly)[0].pieces)
        numbers = ctypes.c_int64 * (2 * (self.parts + len(TIMED)))
        address = loop.code.address(TICKS)
        self.ticks, self.intervals = np.ctypeslib.as_array(numbers.from_address(address)).reshape(2, -1)
        self.clock = ctypes.CFUNCTYPE(ctypes.c_double)(loop.code.address(CLOCK))

    def run(self) -> _Timed:
        self.ticks[:] = self.intervals[:] = 0
        machine.set_clock(self.loop.code.address(CLOCK))
        try:
            before = time.perf_counter(), self.clock()
            self.steps = _run(self.loop, self.model)
            after = time.perf_counter(), self.clock()
        finally:
            machine.set_clock(None)
        tick = (after[0] - before[0]) / (after[1] - before[1])
        return _Timed(float(self.ticks[-1]) * tick / self.steps, self._costs(tick))

    def _costs(self, tick: float) -> tuple[Cost, ...]:
        """The time of each part and stage in a step, less the time of reading the stopwatch."""
        seconds, intervals = self.ticks * (tick / self.steps), self.intervals / self.steps
        *_, reading, whole = seconds
        rest = whole - seconds[:-1].sum() - reading * intervals[:-1].sum()
        corrected = np.maximum(seconds - reading * intervals, 0)
        found = [
            Cost(part.address, part.type.reference, round(calls), float(taken))
            for part, calls, taken in zip(self.model.parts, intervals[: self.parts], corrected, strict=False)
        ]
        measured = {
            name: Cost(name, "MuJoCo", round(calls), float(taken))
            for name, calls, taken in zip(TIMED[:-2], intervals[self.parts :], corrected[self.parts :], strict=False)
        }
        own = measured.pop("own stages")
        mechanics = (Cost(OWN, "", own.calls, own.seconds), *self._mujoco(measured, tick))
        called = [cost for cost in mechanics if cost.calls]
        return (*found, *called, Cost(LOOP, "", 1, max(float(rest), 0.0)))

    def _mujoco(self, measured: Mapping[str, Cost], tick: float) -> Iterator[Cost]:
        """The stages of MuJoCo. Functions that are called alone were measured; MuJoCo has timers for the others."""
        timers, other = self.loop.physics.data.timer, measured[OTHER]
        rest = other.seconds
        for name, cost in measured.items():
            if name != OTHER:
                yield cost
        for name, word in _TIMERS.items():
            if name not in measured or not measured[name].calls:
                timer = timers[int(getattr(mujoco.mjtTimer, f"mjTIMER_{word}"))]
                seconds = float(timer.duration) * tick / self.steps
                rest -= seconds
                yield Cost(name, "MuJoCo", round(timer.number / self.steps), seconds)
        yield Cost(OTHER, "MuJoCo", other.calls, max(rest, 0.0))


def _step(loop: NativeLoop, model: Model) -> float:
    """The wall time of a step in s: that of a whole run, less the time to pose and start the model."""
    began = time.perf_counter()
    _run(loop, model, 1)
    started = time.perf_counter()
    steps = _run(loop, model)
    ended = time.perf_counter()
    return max(ended - started - (started - began), 1e-9) / steps


def _run(loop: NativeLoop, model: Model, most: int | None = None) -> int:
    """Run once and return the number of steps."""
    steps = most or max(1, round(model.simulate.duration / model.simulate.step))
    ending = loop.run(model.values(), steps, recorded=False)
    if ending.failure:
        raise SimulationFailed(ending.failure)
    return max(1, ending.steps)


def _sorted(costs: Iterable[Cost]) -> tuple[Cost, ...]:
    return tuple(sorted(costs, key=lambda cost: -cost.seconds))
