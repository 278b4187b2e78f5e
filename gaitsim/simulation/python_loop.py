"""Normal mode: the closed loop in plain Python, where breakpoint(), print and warnings work.

This is the reference; `native_loop` does the same without Python.
"""

from __future__ import annotations

import contextlib
from bdb import BdbQuit
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.mjcf import tie_place
from gaitsim.compiler.program import STARTING_ROUNDS, Floats, Program
from gaitsim.parts.load import function_of
from gaitsim.simulation.body import Body
from gaitsim.simulation.ending import Ending
from gaitsim.simulation.failure import of_exception, of_values
from gaitsim.simulation.view import View, views


class _Failed(Exception):
    """A component failed; the text says which and why."""


@dataclass
class Normal:
    """A program in plain Python."""

    program: Program
    body: Body = field(init=False)

    def __post_init__(self) -> None:
        self.body = Body(self.program)

    def prepare(self) -> None:
        """Check what only the posed model can tell.

        Errors: InvalidSpec.
        """
        self.body.check_initial()

    def run(self, values: Sequence[float], steps: int, recorded: bool) -> Ending:
        """Simulate one candidate's numbers."""
        self.body.pose(values)
        return _Run(self.program, self.body, values).run(steps, recorded)


class _Run:
    """One run: its tables, and what is called with which views of them."""

    def __init__(self, program: Program, body: Body, values: Sequence[float]) -> None:
        self.program, self.body = program, body
        self.dt = program.model.simulate.step
        self.base = program.input_base(values)
        self.p = program.parameter_table(values)
        self.u = np.zeros(program.inputs.size)
        self.x = np.zeros(program.states.size)
        self.y = np.zeros(program.outputs.size)
        self.initial = body.initial_states(values)
        self.delay_steps = program.delay_steps(values)
        self.lines = [np.zeros(size) for size in program.capacities(values)]
        self.before = [None if line.initial is None else values[line.initial] for line in program.delays]
        everyone = range(len(program.model.parts))
        self.views = [views(program, i, self.p, self.u, self.x, self.y) for i in everyone]
        self.slots = [list(program.inputs.fields[i]) for i in everyone]
        self.functions = [self._functions(i) for i in everyone]
        self.stops = [program.outputs.place(i, "stop") for i in program.stops]

    def run(self, steps: int, recorded: bool) -> Ending:
        record: list[Floats] = []
        done, failure = 0, None
        stopped_by: int | None = None
        try:
            self._start()
            while done < steps:
                mujoco.mj_step1(self.body.model, self.body.data)
                self._read()
                self._outputs(done)
                self._apply(done)
                for line, delay in zip(self.lines, self.program.delays, strict=True):
                    line[done % len(line)] = self.y[delay.source]
                if recorded:
                    record.append(np.concatenate([self.y, self.x])[self.program.signal_places])
                stopped_by = next((s for s in self.stops if self.y[s] > 0.5), None)
                if stopped_by is not None:
                    break
                for part in self.program.updates:
                    self._gather(part, done)
                    self._call(part, "update", done)
                mujoco.mj_step2(self.body.model, self.body.data)
                failure = self.body.divergence(done)
                if failure:
                    break
                done += 1
        except _Failed as error:
            failure = str(error)
        stopper = None if stopped_by is None else self.program.part_of_output(stopped_by)
        # As in native code: the step in which a run fails is not part of its record.
        record = record[: done + (stopper is not None)]
        rows = np.array(record).reshape(-1, len(self.program.signals)) if recorded else None
        return Ending(done, stopper, failure, self.p, self.x, rows)

    def _start(self) -> None:
        """Start all parts in rounds, as native code does."""
        self._read()
        for i in range(STARTING_ROUNDS):
            early = i < STARTING_ROUNDS - 1
            with np.errstate(all="ignore") if early else contextlib.nullcontext():
                self._outputs(0, starting=True, lenient=early)
            self._fill_delays()

    def _fill_delays(self) -> None:
        """Before the start, a delayed signal was what it is at the start."""
        for line, delay, before in zip(self.lines, self.program.delays, self.before, strict=True):
            line[:] = self.y[delay.source] if before is None else before

    def _outputs(self, step: int, starting: bool = False, lenient: bool = False) -> None:
        """Call every `output` in order, at the start after `start`; lenient calls may fail."""
        for call in self.program.calls:
            self._gather(call.part, step)
            with contextlib.suppress(_Failed) if lenient else contextlib.nullcontext():
                if starting and call.last:
                    self._call(call.part, "start", step)
                self._call(call.part, "output", step, check=call.last)

    def _call(self, part: int, stage: str, step: int, check: bool = True) -> None:
        """Call one function of a part; what it raises or leaves not finite ends the run."""
        function = self.functions[part].get(stage)
        p, u, x, y = self.views[part]
        if function is not None:
            arguments = {"start": (p, u, x), "output": (p, u, x, y), "update": (p, u, x, y, self.dt)}
            try:
                function(*arguments[stage])
            except BdbQuit:
                raise KeyboardInterrupt from None  # a debugger's quit ends the command, not this candidate
            except Exception as error:
                raise _Failed(of_exception(self.program, part, stage, step, error)) from error
        if stage == "start":
            for place, value in self.initial.items():
                self.x[place] = value
        if check and not self._finite(part, stage):
            raise _Failed(of_values(self.program, part, stage, step, self.u, self.x, self.y))

    def _finite(self, part: int, stage: str) -> bool:
        layout, table = (
            (self.program.outputs, self.y) if stage == "output" else (self.program.states, self.x)
        )
        begin = layout.offsets[part]
        end = layout.offsets[part + 1] if part + 1 < len(layout.offsets) else layout.size
        return bool(np.all(np.isfinite(table[begin:end])))

    def _gather(self, part: int, step: int) -> None:
        """Sum what arrives at a part's inputs."""
        begin = int(self.program.inputs.offsets[part])
        for slot in range(begin, begin + len(self.slots[part])):
            value = self.base[slot]
            for source, line in self.program.senders[slot]:
                value = value + (self.y[source] if line < 0 else self._delayed(line, step))
            self.u[slot] = value

    def _delayed(self, line: int, step: int) -> Any:
        """A signal of the past, between the two nearest steps."""
        buffer, delay = self.lines[line], self.delay_steps[line]
        whole = int(delay)
        rest = delay - whole
        newest = buffer[(step - whole) % len(buffer)]
        if rest > 0:
            newest = (1 - rest) * newest + rest * buffer[(step - whole - 1) % len(buffer)]
        return newest

    def _read(self) -> None:
        for part, tie in self.body.assembly.reads:
            value = self.body.array(tie.field)[tie_place(self.body.model, tie)]
            self.y[self.program.outputs.place(part, tie.port)] = value

    def _apply(self, step: int) -> None:
        for part in self.body.appliers:
            self._gather(part, step)
        for part, tie in self.body.assembly.applies:
            value = getattr(self._sender(part, tie.port), tie.port)
            self.body.array(tie.field)[tie_place(self.body.model, tie)] = tie.sign * value

    def _sender(self, part: int, port: str) -> View:
        _, u, _, y = self.views[part]
        return y if port in self.program.model.parts[part].type.outputs else u

    def _functions(self, part: int) -> dict[str, Callable[..., None]]:
        kind = self.program.model.parts[part].type
        stages = {"start", "output", "update"} & kind.functions
        return {stage: function_of(kind.cls, stage) for stage in stages}
