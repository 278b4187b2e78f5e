"""The cost of a step of a model, part by part, and stage by stage within MuJoCo."""

from __future__ import annotations

import ctypes
import statistics
import time
from collections.abc import Iterable
from dataclasses import dataclass

import mujoco
import numpy as np

from gaitsim.compiler import machine
from gaitsim.compiler.native import CLOCK, TICKS, TIMED
from gaitsim.compiler.plan import plan_of
from gaitsim.compiler.program import Program
from gaitsim.compiler.stage_code import STAGES
from gaitsim.errors import SimulationFailed
from gaitsim.model import Model
from gaitsim.simulation.native_loop import NativeLoop

PAIRS = 5
LOOP = "delays, checks, loop"
OWN = "paths, contacts, sum of forces"
# MuJoCo's timers that do not contain one another: name here, name there.
_STAGES = {
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
        plan, code = plan_of(loop.program, loop.physics.assembly)[0], loop.code
        self.calls = [sum(call.always for call in plan.calls if call.piece == i) for i in range(len(plan.pieces))]
        self.own = len(STAGES) if plan.own_stages else 0
        for i in plan.updates:
            self.calls[i] += 1
        numbers = ctypes.c_int64 * (len(plan.pieces) + len(TIMED))
        self.ticks = np.ctypeslib.as_array(numbers.from_address(code.address(TICKS)))
        self.clock = ctypes.CFUNCTYPE(ctypes.c_double)(code.address(CLOCK))

    def run(self) -> _Timed:
        self.ticks[:] = 0
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
        """The time of each part of a step, less the time of reading the stopwatch."""
        parts, others = np.split(self.ticks * (tick / self.steps), [len(self.calls)])
        own, first, second, reading, whole = others
        corrected = np.maximum(parts - reading * np.array(self.calls), 0)
        found = [
            Cost(part.address, part.type.reference, calls, float(seconds))
            for part, calls, seconds in zip(self.model.parts, self.calls, corrected, strict=True)
        ]
        timers = self.loop.physics.data.timer
        stages = [
            Cost(name, "MuJoCo", 1, float(timers[int(getattr(mujoco.mjtTimer, f"mjTIMER_{word}"))].duration) * tick)
            for name, word in _STAGES.items()
        ]
        stages = [Cost(stage.name, stage.use, 1, stage.seconds / self.steps) for stage in stages]
        if self.own:
            stages.append(Cost(OWN, "", self.own, float(own - self.own * reading)))
        mechanics = first + second - (2 + self.own) * reading
        stages.append(Cost("other mechanics", "MuJoCo", 2, float(mechanics - sum(stage.seconds for stage in stages))))
        read = sum(self.calls) + len(TIMED) - 2
        rest = whole - parts.sum() - first - second - read * reading
        return (*found, *stages, Cost(LOOP, "", 1, float(rest)))


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
