"""Rapid mode: native code runs on the tables of one candidate."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from gaitsim.compiler import native
from gaitsim.compiler.compilation import compiled
from gaitsim.compiler.machine import Code
from gaitsim.compiler.mjcf import Assembly, tie_place
from gaitsim.compiler.plan import plan_of
from gaitsim.compiler.program import STARTING_ROUNDS, Floats, Integers, Program
from gaitsim.compiler.stage_code import ADDRESSES
from gaitsim.simulation.events import Failed
from gaitsim.simulation.failure import of_nothing_found
from gaitsim.simulation.loop_result import LoopResult
from gaitsim.simulation.physics import Physics
from gaitsim.simulation.python_loop import Checked
from gaitsim.simulation.tables import Tables
from gaitsim.simulation.threads import interruptible

_C_TYPES: Mapping[str, Any] = {
    "integer": ctypes.c_int64,
    "number": ctypes.c_double,
    "pointer": ctypes.c_void_p,
    "shared": ctypes.c_void_p,
}


@dataclass(frozen=True)
class _Native:
    """The native functions of a program for mechanics of one shape. They hold no lock."""

    code: Code  # in memory for as long as this lives
    start: Callable[[Mapping[str, Any]], int]
    run: Callable[[Mapping[str, Any]], int]

    @staticmethod
    def of(code: Code) -> _Native:
        def function(name: str, arguments: Mapping[str, str]) -> Callable[[Mapping[str, Any]], int]:
            kinds = [_C_TYPES[kind] for kind in arguments.values()]
            called = ctypes.CFUNCTYPE(ctypes.c_int64, *kinds)(code.address(name))
            return lambda given: int(called(*(given[word] for word in arguments)))

        return _Native(code, function("start", native.START), function("run", native.RUN))


@dataclass(frozen=True)
class _Reached:
    """How far native code came: whether all parts started, how it ended, in which step, and the tables then."""

    started: bool
    status: int
    step: int
    tables: Tables


@dataclass
class NativeLoop:
    """A program in native code.

    Attributes:
        timed: Whether it has a stopwatch; see `simulation/profile.py`.
    """

    program: Program
    timed: bool = False
    physics: Physics = field(init=False)
    _natives: dict[Any, _Native] = field(default_factory=dict)
    _tied: tuple[Assembly, _Native, Integers] | None = None

    def __post_init__(self) -> None:
        self.physics = Physics(self.program, native=True)

    def prepare(self) -> None:
        """Compile or load all native code, and make the checks that need the posed model.

        Raises:
            InvalidComponent: A component file breaks the contract.
            InvalidSpec: The spec breaks a rule.
        """
        self.physics.check_initial()
        self._bound()

    @property
    def code(self) -> Code:
        """The native code for the present mechanics."""
        return self._bound()[0].code

    def run(self, values: Sequence[float], steps: int, recorded: bool) -> LoopResult:
        """Simulate one candidate.

        Args:
            values: All numbers of the model, in SI.
            steps: The largest number of steps.
            recorded: Whether to record signals.
        """
        record = np.zeros((steps, len(self.program.signals))) if recorded else None
        reached = self._reach(values, steps, record)
        failure, stopped_by = None, None
        if reached.status == native.SUSPECT:
            failure = self._culprit(values, reached)
        elif reached.status == native.DIVERGED:
            failure = self.physics.divergence(reached.step)
        elif reached.status >= native.STOPPED:
            stopped_by = self.program.stops[reached.status - native.STOPPED]
        whole = stopped_by is not None or reached.status == native.DIVERGED
        rows = None if record is None else record[: reached.step + whole]
        return LoopResult(reached.step, stopped_by, failure, reached.tables.p, reached.tables.x, rows)

    def _reach(self, values: Sequence[float], steps: int, record: Floats | None = None) -> _Reached:
        """Pose and start a candidate, and simulate a number of steps."""
        physics = self.physics
        physics.pose(values)
        tables = self._tables(values)
        code, addresses = self._bound()
        step = np.zeros(1, dtype=np.int64)
        held = {
            "parameters": tables.p,
            "base": tables.base,
            "states": tables.x,
            "outputs": tables.y,
            "past": tables.past,
            "whole": tables.whole,
            "rest": tables.rest,
            "before": tables.before,
            "places": tables.places,
            "values": tables.values,
            "ties": addresses,
            "written": tables.written,
            "qpos": physics.data.qpos,
            "qvel": physics.data.qvel,
            "reached": step,
            "stages": self._stage_addresses(),
        }
        dt = self.program.model.simulate.step
        numbers: dict[str, Any] = {"dt": dt, "fastest": physics.fastest, "rounds": STARTING_ROUNDS}
        numbers |= {"mask": len(tables.past) - 1, "count": len(tables.places), "first": 0, "steps": steps}
        model, data = physics.model, physics.data

        def compute() -> tuple[bool, int]:
            # The arrays live as long as this function, in whatever thread it runs. An address, unlike a pointer of
            # ctypes, keeps none of them alive beyond that.
            given = numbers | {word: array.ctypes.data for word, array in held.items()}
            given |= {"record": None if record is None else record.ctypes.data}
            if code.start(given):
                return False, native.SUSPECT
            return True, code.run(given | {"model": model._address, "data": data._address})

        try:
            started, status = interruptible(compute)
        except KeyboardInterrupt:
            self.physics = Physics(self.program, native=True)  # a thread still computes with the old one
            raise
        return _Reached(started, status, int(step[0]), tables)

    def _culprit(self, values: Sequence[float], noticed: _Reached) -> str:
        """Find what failed: native code runs up to the failure once more, then Python continues and checks every
        call.
        """
        try:
            if not noticed.started:
                self.physics.pose(values)
                Checked(self.program, self.physics, self._tables(values)).start()
            else:
                before = self._reach(values, noticed.step)
                Checked(self.program, self.physics, before.tables).step(noticed.step)
        except Failed as error:
            return str(error)
        return of_nothing_found(self.program, noticed.step)

    def _tables(self, values: Sequence[float]) -> Tables:
        return Tables.of(self.program, values, self.physics.initial_states(values), len(self.physics.assembly.applies))

    def _bound(self) -> tuple[_Native, Integers]:
        """The native code for the present mechanics, and the addresses in MuJoCo's data that it reads and writes.

        Raises:
            InvalidComponent: A component file breaks the contract.
        """
        assembly = self.physics.assembly
        if self._tied is None or self._tied[0] is not assembly:
            ties = (assembly.reads, assembly.applies, assembly.resets)
            shape = (*ties, assembly.model.nq, assembly.model.nv)
            if shape not in self._natives:
                self._natives[shape] = _Native.of(compiled(*plan_of(self.program, assembly), self.timed))
            self._tied = assembly, self._natives[shape], self._addresses()
        return self._tied[1:]

    def _stage_addresses(self) -> Integers:
        """The addresses of what the stages of gaitsim's own read and write; none if there are no such stages."""
        made = self.physics.stages
        return np.array([made.arrays[name].ctypes.data for name in ADDRESSES] if made else [], dtype=np.int64)

    def _addresses(self) -> Integers:
        physics, assembly = self.physics, self.physics.assembly
        ties = (*assembly.reads, *assembly.applies, *assembly.resets)
        arrays = {tie.field: physics.array(tie.field) for _, tie in ties}
        places = [arrays[t.field].ctypes.data + arrays[t.field].itemsize * tie_place(physics.model, t) for _, t in ties]
        return np.array([*places, physics.array("qacc").ctypes.data], dtype=np.int64)
