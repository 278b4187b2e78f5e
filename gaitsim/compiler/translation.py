"""A plan in LLVM IR: a function that starts a model and a function that runs it.

Everything that does not depend on the candidate is a constant. `simulation/python_loop.py` does the same in plain
Python and should be read first.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

from gaitsim.compiler.events import Events
from gaitsim.compiler.instant import OUTPUTS, Instant
from gaitsim.compiler.mujoco_step import MujocoStep
from gaitsim.compiler.native import COMPLETED, DIVERGED, FRAME, RUN, START, STOPPED, SUSPECT
from gaitsim.compiler.records import Records
from gaitsim.compiler.writer import DOUBLE, FLAG, INTEGER, Writer


class Translation(Instant):
    """Both functions, and those that they call."""

    @cached_property
    def records(self) -> Records:
        """The writer of the code that stores signals."""
        return Records(self.text, self.names, self._function, self.plan)

    def module(self) -> Any:
        """The whole module. Kernels and functions of MuJoCo are only declared."""
        self._finite()
        self._bounded()
        self.records.copy()
        self._start()
        self._run()
        return self.text

    # --- starting ---

    def _start(self) -> None:
        """Emit the start of all parts, in rounds that resolve circular dependencies. Only failures in the last round
        count.
        """
        f = self._function("start", INTEGER, START, exported=True)
        f.arguments["step"] = INTEGER(0)
        for i, (place, _) in enumerate(self.plan.reads):
            self._read(f, i, place)
        with f.times(f.rounds) as turn:
            strict = f.builder.icmp_signed("==", turn, f.builder.sub(f.rounds, INTEGER(1)))
            given = [f.arguments[word] for word in OUTPUTS if word in f.arguments]
            for chunk in self._chunks("outputs", self.plan.calls, OUTPUTS, self._output):
                good = f.builder.call(chunk, [*given, FLAG(1), strict], attrs=("noinline",))
                f.return_if(f.builder.not_(good), INTEGER(SUSPECT))
            self._fill(f)
        f.builder.ret(INTEGER(COMPLETED))

    def _fill(self, f: Writer) -> None:
        """Emit the filling of the delay lines with the signals at the start."""
        b = f.builder
        for line, sender in enumerate(self.plan.lines):
            given = f.load(f.before, line)
            sent = b.select(b.fcmp_unordered("uno", given, given), f.load(f.outputs, sender), given)
            f.store(sent, f.past, line)
        numbers = INTEGER(len(self.plan.lines))
        with f.times(b.mul(b.add(f.mask, INTEGER(1)), numbers), first=len(self.plan.lines)) as place:
            f.store(f.load(f.past, b.sub(place, numbers)), f.past, place)

    # --- running ---

    def _run(self) -> None:
        """Emit the loop over steps: from `first` until `steps` are done, or something ends the run in the step
        `reached`.
        """
        f = self._function("run", INTEGER, RUN, exported=True)
        b = f.builder
        entry, loop, done = b.block, b.append_basic_block("step"), b.append_basic_block("done")
        b.cbranch(b.icmp_signed("<", f.first, f.steps), loop, done)
        b.position_at_end(loop)
        step = b.phi(INTEGER)
        step.add_incoming(f.first, entry)
        f.arguments["step"] = step
        self._one_step(f)
        following = b.add(step, INTEGER(1))
        step.add_incoming(following, b.block)
        b.cbranch(b.icmp_signed("<", following, f.steps), loop, done)
        b.position_at_end(done)
        b.store(f.steps, f.reached)
        b.ret(INTEGER(COMPLETED))

    def _one_step(self, f: Writer) -> None:
        b, plan = f.builder, self.plan
        self._look(f, lambda good, status: self._end_unless(f, good, status))
        self._write(f)
        row = self._row(f, f.step)
        for line, sender in enumerate(plan.lines):
            f.store(f.load(f.outputs, sender), row, line)
        self.records.record(f)
        for i, place in enumerate(plan.stops):
            running = b.fcmp_ordered("<=", f.load(f.outputs, place), DOUBLE(0.5))
            self._end_unless(f, running, STOPPED + i)
        frame = [f.arguments[word] for word in FRAME]
        for chunk in self._chunks("updates", plan.updates, FRAME, self._update):
            self._end_unless(f, b.call(chunk, frame, attrs=("noinline",)), SUSPECT)
        self._end_unless(f, self._table_is_finite(f, f.states, plan.states), SUSPECT)
        self._advance(f)
        positions, velocities = plan.coordinates
        finite = self._is_finite(f, f.qpos, positions)
        followed = b.call(self.names["bounded"], [f.qvel, INTEGER(velocities), f.fastest], attrs=("noinline",))
        self._end_unless(f, b.and_(finite, followed), DIVERGED)

    def _advance(self, f: Writer) -> None:
        """Emit the second half of MuJoCo's step."""
        if self.plan.guards:
            self._end_unless(f, Events(self).advance(f), SUSPECT)
        else:
            MujocoStep(self).advance(f)

    def _end_unless(self, f: Writer, good: Any, status: int) -> None:
        with f.builder.if_then(f.builder.not_(good), likely=False):
            f.builder.store(f.step, f.reached)
            f.builder.ret(INTEGER(status))

    def _update(self, f: Writer, index: int) -> None:
        with self._timed(f, index):
            self._stage(f, index, "update", self._gather(f, index), FLAG(1))
