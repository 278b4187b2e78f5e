"""Normal mode: the closed loop in plain Python, where breakpoint(), print and warnings work.

This is the reference. Native code (`compiler/native.py`) computes the same without Python. If native code finds a
number that is not finite, the step is repeated here, to report where and why.
"""

from __future__ import annotations

import contextlib
from bdb import BdbQuit
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from gaitsim.compiler.kernel import STAGES
from gaitsim.compiler.mjcf import tie_place
from gaitsim.compiler.program import STARTING_ROUNDS, Floats, Integers, Program
from gaitsim.components.load import function_of
from gaitsim.simulation.events import Failed, advance
from gaitsim.simulation.failure import of_exception, of_values
from gaitsim.simulation.loop_result import LoopResult
from gaitsim.simulation.physics import Physics
from gaitsim.simulation.tables import Tables
from gaitsim.simulation.view import views


@dataclass
class PythonLoop:
    """A program in plain Python."""

    program: Program
    physics: Physics = field(init=False)

    def __post_init__(self) -> None:
        self.physics = Physics(self.program)

    def prepare(self) -> None:
        """Make the checks that need the posed model.

        Raises:
            InvalidSpec: An initial value is not that of a coordinate or a state.
        """
        self.physics.check_initial()

    def run(self, values: Sequence[float], steps: int, recorded: bool) -> LoopResult:
        """Simulate one candidate.

        Args:
            values: All numbers of the model, in SI.
            steps: The largest number of steps.
            recorded: Whether to record signals.
        """
        self.physics.pose(values)
        states, applied = self.physics.initial_states(values), len(self.physics.assembly.applies)
        tables = Tables.of(self.program, values, states, applied)
        checked = Checked(self.program, self.physics, tables)
        record: list[Floats] = []
        done, failure = 0, None
        diverged: str | None = None
        stopper: int | None = None
        try:
            checked.start()
            while done < steps:
                checked.outputs(done)
                if recorded:
                    record.append(np.concatenate([tables.y[: self.program.outputs.size], tables.x])[self._signals])
                stopper = checked.stopper
                if stopper is not None:
                    break
                checked.update(done)
                failure = diverged = self.physics.divergence(done)
                if diverged:
                    break
                done += 1
        except Failed as error:
            failure = str(error)
        # As in native code, the instant at which a part fails is not recorded; that before a divergence is.
        record = record[: done + (stopper is not None or diverged is not None)]
        rows = np.array(record).reshape(-1, len(self.program.signals)) if recorded else None
        return LoopResult(done, stopper, failure, tables.p, tables.x, rows)

    @property
    def _signals(self) -> Integers:
        return self.program.signal_places


class Checked:
    """The steps of one run on its tables. Every call of a component is checked."""

    def __init__(self, program: Program, physics: Physics, tables: Tables) -> None:
        self.program, self.physics, self.tables = program, physics, tables
        self.dt = program.model.simulate.step
        everyone = range(len(program.model.parts))
        self.views = [views(program, i, tables.p, tables.u, tables.x, tables.y) for i in everyone]
        self.slots = [program.inputs.span(i) for i in everyone]
        self.functions = [self._functions(i) for i in everyone]
        self.stops = [program.outputs.place(i, "stop") for i in program.stops]

    def start(self) -> None:
        """Start all parts, in rounds that resolve circular dependencies such as fiber, reflex and activation.

        Raises:
            Failed: A component fails.
        """
        self._read()
        for i in range(STARTING_ROUNDS):
            early = i < STARTING_ROUNDS - 1
            # Errors in early rounds, in which inputs are missing, are not failures.
            with np.errstate(all="ignore") if early else contextlib.nullcontext():
                self._outputs(0, starting=True, lenient=early)
            self._fill_delays()

    def step(self, step: int) -> None:
        """Simulate one step.

        Raises:
            Failed: A component fails.
        """
        self.outputs(step)
        self.update(step)

    def outputs(self, step: int) -> None:
        """The first half of a step: compute all outputs, and write them to MuJoCo and to the delay lines.

        Raises:
            Failed: A component fails.
        """
        self.look(step)
        self.apply(step)
        past = self.tables.past
        past[step % len(past)] = [self.tables.y[delay.sender] for delay in self.program.delays]

    def look(self, step: int) -> None:
        """Compute all outputs at the present positions and velocities of MuJoCo.

        Raises:
            Failed: A component fails.
        """
        self.physics.look()
        self._read()
        self._outputs(step)

    @property
    def stopper(self) -> int | None:
        """The part that ends the run at this instant; None if none does."""
        found = next((s for s in self.stops if self.tables.y[s] > 0.5), None)
        return None if found is None else self.program.part_of_output(found)

    def update(self, step: int) -> None:
        """The second half of a step: advance the states of all parts and of MuJoCo.

        Raises:
            Failed: A component fails.
        """
        for part in self.program.updates:
            self.gather(part, step)
            self.call(part, "update", step)
        self._advance(step)

    def _fill_delays(self) -> None:
        """Fill the delay lines with the signals at the start."""
        for k, (delay, before) in enumerate(zip(self.program.delays, self.tables.before, strict=True)):
            self.tables.past[:, k] = self.tables.y[delay.sender] if np.isnan(before) else before

    def _outputs(self, step: int, starting: bool = False, lenient: bool = False) -> None:
        """Call every `output` in order; at the start, each `start` comes before. Lenient calls may fail."""
        for call in self.program.calls:
            self.gather(call.part, step)
            with contextlib.suppress(Failed) if lenient else contextlib.nullcontext():
                if starting and call.last:
                    self.call(call.part, "start", step)
                self.call(call.part, "output", step, check=call.last)

    def call(self, part: int, stage: str, step: int, check: bool = True, time: float | None = None) -> None:
        """Call one function of a part. The run ends if it raises or sets a number that is not finite.

        Args:
            part: The index of the part.
            stage: The name of the function.
            step: The index of the step.
            check: Whether to check for numbers that are not finite.
            time: For `reset`, the instant of the event in s.
        """
        function = self.functions[part].get(stage)
        p, u, x, y = self.views[part]
        if function is not None:
            arguments = {"start": (p, u, x), "output": (p, u, x, y)}
            try:
                function(*arguments.get(stage, (p, u, x, y, self.dt if time is None else time)))
            except BdbQuit:
                raise KeyboardInterrupt from None  # a debugger's quit ends the command, not this candidate
            except Exception as error:
                raise Failed(of_exception(self.program, part, stage, step, error)) from error
        if stage == "start":
            self.tables.x[self.tables.places] = self.tables.values
        if check and not self._finite(part, stage):
            raise Failed(of_values(self.program, part, stage, step, self.tables.u, self.tables.x, self.tables.y))

    def _finite(self, part: int, stage: str) -> bool:
        layout, table = (
            (self.program.outputs, self.tables.y) if stage == "output" else (self.program.states, self.tables.x)
        )
        span = layout.span(part)
        return bool(np.all(np.isfinite(table[span.start : span.stop])))

    def gather(self, part: int, step: int) -> None:
        """Sum the senders of a part's inputs."""
        for slot in self.slots[part]:
            value = self.tables.base[slot]
            for sender, line in self.program.senders[slot]:
                value = value + (self.tables.y[sender] if line < 0 else self._delayed(line, step))
            self.tables.u[slot] = value

    def _delayed(self, line: int, step: int) -> Any:
        """A past signal, interpolated between the two nearest steps."""
        past, rest = self.tables.past, self.tables.rest[line]
        newest = step - self.tables.whole[line]
        newer, older = past[newest % len(past), line], past[(newest - 1) % len(past), line]
        return (1 - rest) * newer + rest * older

    def _read(self) -> None:
        for part, tie in self.physics.assembly.reads:
            value = self.physics.array(tie.field)[tie_place(self.physics.model, tie)]
            self.tables.y[self.program.outputs.place(part, tie.port)] = value

    def apply(self, step: int) -> None:
        """Write forces and controls to MuJoCo."""
        for part in self.physics.appliers:
            self.gather(part, step)
        for k, (part, tie) in enumerate(self.physics.assembly.applies):
            value = tie.sign * self.sent(part, tie.port)
            if self.physics.assembly.runge_kutta:
                value = self._carried_on(k, value)
            self.physics.array(tie.field)[tie_place(self.physics.model, tie)] = value

    def _carried_on(self, number: int, value: Any) -> Any:
        """A written value, extrapolated to the middle of the step. In the first step it is constant."""
        before = self.tables.written[number]
        self.tables.written[number] = value
        return value if np.isnan(before) else 1.5 * value - 0.5 * before

    def _advance(self, step: int) -> None:
        """The second half of MuJoCo's step."""
        if self.program.guarded:
            advance(self, step)
        else:
            self.physics.advance()

    def sent(self, part: int, port: str) -> Any:
        """The value of an output of a part, or of an input."""
        _, u, _, y = self.views[part]
        return getattr(y if port in self.program.model.parts[part].type.outputs else u, port)

    def _functions(self, part: int) -> dict[str, Callable[..., None]]:
        kind = self.program.model.parts[part].type
        stages = STAGES.keys() & kind.functions
        return {stage: function_of(kind.cls, stage) for stage in stages}
