"""Steps with events in LLVM IR: Runge-Kutta steps of order 4, divided where an output `guard` rises through 0.

`simulation/events.py` does the same in plain Python and should be read first.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from gaitsim.compiler.instant import Instant
from gaitsim.compiler.mjcf import AFTER_VELOCITIES
from gaitsim.compiler.native import EVENTS, FRAME, HALVINGS, RUNGE_KUTTA, STAGE_OF
from gaitsim.compiler.writer import DOUBLE, FLAG, INTEGER, NOTHING, POINTER, SHORT, Writer

_STEP = {**FRAME, "ties": "pointer", **dict.fromkeys(("model", "data", "qpos", "qvel"), "shared")}
_MOVE = {**_STEP, "begin": "pointer", "speed": "pointer", "span": "number"}


@dataclass
class Events:
    """The steps of a plan with guards."""

    of: Instant

    def advance(self, f: Writer) -> Any:
        """Emit one whole step of the mechanics.

        Returns:
            The flag of success.
        """
        if "advance" not in self.of.names:
            self._look()
            self._rates()
            self._move()
            self._advance()
        return self._call(f, "advance", _STEP)

    def _call(self, f: Writer, name: str, kinds: Mapping[str, str], *more: Any) -> Any:
        given = [f.arguments[word] for word in kinds]
        return f.builder.call(self.of.names[name], [*given, *more], attrs=("noinline",))

    def _function(self, name: str, kinds: Mapping[str, str]) -> Writer:
        return self.of._function(name, FLAG, kinds, apart=False)

    # --- one stage ---

    def _look(self) -> None:
        """Emit the outputs at the present positions and velocities."""
        f = self._function("look", _STEP)
        self.of._look(f, lambda good, _: f.return_if(f.builder.not_(good), FLAG(0)))
        f.builder.ret(FLAG(1))

    def _rates(self) -> None:
        """Emit the outputs and the accelerations that follow from them."""
        f = self._function("rates", _STEP)
        f.return_if(f.builder.not_(self._call(f, "look", _STEP)), FLAG(0))
        self.of._write(f)
        forward = self.of._external("mj_forwardSkip", NOTHING, [POINTER, POINTER, SHORT, SHORT])
        with self.of._timed(f, STAGE_OF["mj_forwardSkip"]):
            f.builder.call(forward, [f.model, f.data, SHORT(AFTER_VELOCITIES), SHORT(0)])
        f.builder.ret(FLAG(1))

    # --- one step of Runge-Kutta ---

    def _move(self) -> None:
        """Emit a Runge-Kutta step of length `span` from `begin` and `speed`, and the outputs at its end."""
        f = self._function("move", _MOVE)
        b, size = f.builder, self.of.plan.coordinates[0]
        velocities, accelerations = (b.alloca(DOUBLE, size=max(size, 1)) for _ in range(2))
        acceleration = f.load(f.ties, self._resets + len(self.of.plan.resets), POINTER)
        for stage, (share, weight) in enumerate(RUNGE_KUTTA):
            with f.times(INTEGER(size)) as i:
                if stage:
                    self._shift(f, i, b.fmul(DOUBLE(share), f.span), f.load(f.qvel, i), f.load(acceleration, i))
                else:
                    f.store(f.load(f.begin, i), f.qpos, i)
                    f.store(f.load(f.speed, i), f.qvel, i)
            f.return_if(b.not_(self._call(f, "rates", _STEP)), FLAG(0))
            with f.times(INTEGER(size)) as i:
                for sums, rate in ((velocities, f.load(f.qvel, i)), (accelerations, f.load(acceleration, i))):
                    weighed = b.fmul(DOUBLE(weight), rate)
                    f.store(b.fadd(f.load(sums, i), weighed) if stage else weighed, sums, i)
        with f.times(INTEGER(size)) as i:
            sixth = b.fdiv(f.span, DOUBLE(6.0))
            self._shift(f, i, sixth, f.load(velocities, i), f.load(accelerations, i))
        b.ret(self._call(f, "look", _STEP))

    def _shift(self, f: Writer, i: Any, time: Any, velocity: Any, acceleration: Any) -> None:
        """Emit one coordinate and its rate after a time, from their values at the beginning and the given rates."""
        b = f.builder
        f.store(b.fadd(f.load(f.begin, i), b.fmul(time, velocity)), f.qpos, i)
        f.store(b.fadd(f.load(f.speed, i), b.fmul(time, acceleration)), f.qvel, i)

    # --- a step cut at its events ---

    @property
    def _resets(self) -> int:
        """The first address of the numbers that events set."""
        return len(self.of.plan.reads) + len(self.of.plan.writes)

    def _advance(self) -> None:
        f = self._function("advance", _STEP)
        b, plan, size = f.builder, self.of.plan, INTEGER(self.of.plan.coordinates[0])
        for name, numbers in (("begin", size), ("speed", size), ("before", INTEGER(len(plan.guards)))):
            f.arguments[name] = b.alloca(DOUBLE, size=numbers)
        done, low, high = (b.alloca(DOUBLE) for _ in range(3))
        b.store(DOUBLE(0), done)
        with f.times(INTEGER(EVENTS)):
            with f.times(size) as i:
                f.store(f.load(f.qpos, i), f.begin, i)
                f.store(f.load(f.qvel, i), f.speed, i)
            self._remember(f)
            f.return_if(b.not_(self._call(f, "look", _STEP)), FLAG(0))
            with b.if_then(b.not_(self._risen(f))):
                self._remember(f)
                b.store(DOUBLE(0), low)
                b.store(b.fsub(f.dt, b.load(done, typ=DOUBLE)), high)
                self._to(f, b.load(high, typ=DOUBLE))
                f.return_if(b.not_(self._risen(f)), FLAG(1))
                self._halve(f, low, high)
                self._to(f, b.load(high, typ=DOUBLE))
                b.store(b.fadd(b.load(done, typ=DOUBLE), b.load(high, typ=DOUBLE)), done)
            self._reset(f, b.load(done, typ=DOUBLE))
        b.ret(FLAG(0))

    def _remember(self, f: Writer) -> None:
        for k, (_, guard) in enumerate(self.of.plan.guards):
            f.store(f.load(f.outputs, guard), f.before, k)

    def _halve(self, f: Writer, low: Any, high: Any) -> None:
        """Emit the bisection that brings `low` and `high` together at the first event between them."""
        b = f.builder
        with f.times(INTEGER(HALVINGS)):
            least, most = b.load(low, typ=DOUBLE), b.load(high, typ=DOUBLE)
            middle = b.fadd(least, b.fmul(DOUBLE(0.5), b.fsub(most, least)))
            self._to(f, middle)
            risen = self._risen(f)
            b.store(b.select(risen, least, middle), low)
            b.store(b.select(risen, middle, most), high)

    def _to(self, f: Writer, span: Any) -> None:
        f.return_if(f.builder.not_(self._call(f, "move", _STEP, f.begin, f.speed, span)), FLAG(0))

    def _risen(self, f: Writer, only: int | None = None) -> Any:
        """Emit the test whether a guard, of one part or of any, rose through 0."""
        b, found = f.builder, FLAG(0)
        for k, (_, guard) in enumerate(self.of.plan.guards):
            if only in (None, k):
                below = b.fcmp_ordered("<", f.load(f.before, k), DOUBLE(0))
                above = b.fcmp_ordered(">=", f.load(f.outputs, guard), DOUBLE(0))
                found = b.or_(found, b.and_(below, above))
        return found

    def _reset(self, f: Writer, elapsed: Any) -> None:
        """Emit what the events of this instant change: coordinates, and states of their parts."""
        b, plan = f.builder, self.of.plan
        pairs = [tuple(self._sent(f, *each) for each in pair) for pair in plan.resets]
        for k, (value, when) in enumerate(pairs):
            with b.if_then(b.fcmp_ordered(">", when, DOUBLE(0.5))):
                b.store(value, f.load(f.ties, self._resets + k, POINTER))
        time = b.fadd(b.fmul(b.sitofp(f.step, DOUBLE), f.dt), elapsed)
        at = Writer(b, {**f.arguments, "dt": time})
        for k, (index, _) in enumerate(plan.guards):
            with b.if_then(self._risen(f, k)):
                self.of._stage(at, index, "reset", self.of._gather(f, index), FLAG(1))
        f.return_if(b.not_(self.of._table_is_finite(f, f.states, plan.states)), FLAG(0))

    def _sent(self, f: Writer, of_outputs: bool, place: int) -> Any:
        return f.load(f.outputs, place) if of_outputs else self.of._arriving(f, place)
