"""A plan in LLVM IR: a function that starts a model and a function that runs it.

Everything that does not depend on the candidate is a constant. `simulation/python_loop.py` does the same in plain
Python and should be read first.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from llvmlite import ir

from gaitsim.compiler.events import Events
from gaitsim.compiler.kernel import STAGES
from gaitsim.compiler.mjcf import AFTER_VELOCITIES
from gaitsim.compiler.native import COMPLETED, DIVERGED, FRAME, PADDING, RUN, START, STOPPED, SUSPECT, padded
from gaitsim.compiler.plan import Piece, Plan, Step
from gaitsim.compiler.records import Records
from gaitsim.compiler.writer import DOUBLE, FLAG, INTEGER, NOTHING, POINTER, SHORT, Writer

# Kernels of more parts than this are called instead of inlined, so that their code stays in the cache.
_COPIES = 3
# Calls of parts in one function. The time of LLVM grows faster than the length of a function.
_CHUNK = 64

_LANES = ir.VectorType(DOUBLE, 8)
_KINDS = {"flag": FLAG, "integer": INTEGER, "number": DOUBLE, "pointer": POINTER, "shared": POINTER}
# Arguments of the functions that call `output` of all parts, at the start and later, and of starting a part.
_OUTPUTS = {**FRAME, "places": "pointer", "values": "pointer", "count": "integer", "starting": "flag", "strict": "flag"}
_BEGIN = ("dt", "states", "places", "values", "count")


@dataclass
class Translation:
    plan: Plan
    text: Any = field(default_factory=lambda: ir.Module("program"))
    names: dict[str, Any] = field(default_factory=dict)

    @cached_property
    def users(self) -> Counter[str]:
        """The number of parts of each kernel."""
        return Counter(piece.kernel for piece in self.plan.pieces)

    @cached_property
    def records(self) -> Records:
        """The writer of the code that stores signals."""
        return Records(self.text, self.names, self._function, self.plan)

    def module(self) -> Any:
        """The whole module. Kernels and functions of MuJoCo are only declared."""
        self._finite()
        self._bounded()
        self.records.kept()
        self._start()
        self._run()
        return self.text

    def _function(
        self, name: str, returns: Any, arguments: Mapping[str, str], exported: bool = False, apart: bool = True
    ) -> Writer:
        """A new function.

        Args:
            apart: Whether its pointers never refer to the same number; those of MuJoCo are excepted.
        """
        kinds = [_KINDS[kind] for kind in arguments.values()]
        function = ir.Function(self.text, ir.FunctionType(returns, kinds), name)
        self.names[name] = function
        for argument, (word, kind) in zip(function.args, arguments.items(), strict=True):
            argument.name = word
            if apart and kind == "pointer":
                argument.add_attribute("noalias")
        if not exported:
            function.linkage = "internal"
        named = dict(zip(arguments, function.args, strict=True))
        return Writer(ir.IRBuilder(function.append_basic_block("entry")), named)

    def _external(self, name: str, returns: Any, arguments: Iterable[Any]) -> Any:
        if name not in self.names:
            self.names[name] = ir.Function(self.text, ir.FunctionType(returns, list(arguments)), name)
        return self.names[name]

    # --- checks ---

    def _finite(self) -> None:
        """Emit the test whether all numbers of a table are finite: 0 times each of them is then 0."""
        f = self._function("finite", FLAG, {"table": "pointer", "count": "integer"})
        total = f.builder.alloca(DOUBLE)
        f.builder.store(DOUBLE(0), total)
        with f.times(f.count) as i:
            nothing = f.builder.fmul(f.load(f.table, i), DOUBLE(0))
            f.builder.store(f.builder.fadd(f.builder.load(total, typ=DOUBLE), nothing), total)
        f.builder.ret(f.builder.fcmp_ordered("==", f.builder.load(total, typ=DOUBLE), DOUBLE(0)))

        g = self._function("finite_padded", FLAG, {"table": "pointer", "count": "integer"})
        zeros = ir.Constant(_LANES, [0.0] * 8)
        sums = [g.builder.alloca(_LANES) for _ in range(PADDING // 8)]
        for each in sums:
            g.builder.store(zeros, each)
        with g.times(g.count, PADDING) as i:
            for lane, each in enumerate(sums):
                place = g.place(g.table, g.builder.add(i, INTEGER(8 * lane)))
                nothing = g.builder.fmul(g.builder.load(place, align=8, typ=_LANES), zeros)
                g.builder.store(g.builder.fadd(g.builder.load(each, typ=_LANES), nothing), each)
        total = zeros
        for each in sums:
            total = g.builder.fadd(total, g.builder.load(each, typ=_LANES))
        found = FLAG(1)
        for lane in range(8):
            number = g.builder.extract_element(total, SHORT(lane))
            found = g.builder.and_(found, g.builder.fcmp_ordered("==", number, DOUBLE(0)))
        g.builder.ret(found)

    def _bounded(self) -> None:
        """Emit the test whether no absolute value in a table exceeds a bound; a number that is not finite does."""
        f = self._function("bounded", FLAG, {"table": "pointer", "count": "integer", "most": "number"})
        b = f.builder
        found = b.alloca(FLAG)
        b.store(FLAG(1), found)
        with f.times(f.count) as i:
            size = b.call(self._external("llvm.fabs.f64", DOUBLE, [DOUBLE]), [f.load(f.table, i)])
            b.store(b.and_(b.load(found, typ=FLAG), b.fcmp_ordered("<=", size, f.most)), found)
        b.ret(b.load(found, typ=FLAG))

    def _is_finite(self, f: Writer, table: Any, size: int) -> Any:
        return f.builder.call(self.names["finite"], [table, INTEGER(size)], attrs=("noinline",))

    # --- parts ---

    def _stage(self, f: Writer, index: int, stage: str, scratch: Any, strict: Any) -> None:
        """Emit a call of one function of a part. It returns early on errors, and before numbers on which the part
        might never end.
        """
        piece = self.plan.pieces[index]
        if stage not in piece.stages:
            return
        if piece.wary:
            unready = f.builder.not_(self._is_finite(f, scratch, len(piece.inputs)))
            f.return_if(f.builder.and_(strict, unready), FLAG(0))
        copied = self.users[piece.kernel] <= _COPIES
        arguments = [*self._own_tables(f, piece, scratch), f.dt]
        attributes = ("alwaysinline" if copied else "noinline",)
        raised = f.builder.call(self._kernel(piece, stage), arguments, attrs=attributes)
        f.return_if(f.builder.and_(strict, raised), FLAG(0))

    def _own_tables(self, f: Writer, piece: Piece, scratch: Any) -> list[Any]:
        """Emit the addresses of a part's own numbers: p, u, x and y."""
        return [
            f.place(f.parameters, piece.parameters),
            scratch,
            f.place(f.states, piece.states.start),
            f.place(f.outputs, piece.outputs.start),
        ]

    def _kernel(self, piece: Piece, stage: str) -> Any:
        """The function of a kernel for one stage, which returns whether it raised."""
        name = f"{piece.kernel}.{stage}"
        if name not in self.names:
            names = ("p", "u", "x", "y")
            f = self._function(name, FLAG, {**dict.fromkeys(names, "pointer"), "dt": "number"})
            kinds = [POINTER, POINTER, INTEGER, *[POINTER] * 4, DOUBLE]
            kernel = self._external(piece.kernel, SHORT, kinds)
            result, raised = f.builder.alloca(INTEGER), f.builder.alloca(POINTER)
            f.builder.store(ir.Constant(POINTER, None), raised)
            tables = [f.arguments[each] for each in names]
            status = f.builder.call(kernel, [result, raised, INTEGER(STAGES[stage]), *tables, f.dt])
            f.builder.ret(f.builder.icmp_signed("!=", status, SHORT(0)))
        return self.names[name]

    def _gather(self, f: Writer, index: int) -> Any:
        """Emit the inputs of a part, in a table of its own."""
        inputs = self.plan.pieces[index].inputs
        with f.builder.goto_entry_block():
            scratch = f.builder.alloca(DOUBLE, size=max(1, len(inputs)))
        for slot in inputs:
            f.store(self._arriving(f, slot), scratch, slot - inputs.start)
        return scratch

    def _arriving(self, f: Writer, slot: int) -> Any:
        """Emit the sum of the senders of one input."""
        value = f.load(f.base, slot) if self.plan.constant[slot] else DOUBLE(0)
        for sender, line in self.plan.senders[slot]:
            sent = f.load(f.outputs, sender) if line < 0 else self._delayed(f, line)
            value = f.builder.fadd(value, sent)
        return value

    def _delayed(self, f: Writer, line: int) -> Any:
        """Emit a past signal, interpolated between the two nearest steps."""
        b = f.builder
        newest = b.sub(f.step, f.load(f.whole, line, INTEGER))
        rest = f.load(f.rest, line)
        newer, older = (self._kept_at(f, at, line) for at in (newest, b.sub(newest, INTEGER(1))))
        return b.fadd(b.fmul(b.fsub(DOUBLE(1), rest), newer), b.fmul(rest, older))

    def _kept_at(self, f: Writer, step: Any, line: int) -> Any:
        return f.load(self._row(f, step), line)

    def _row(self, f: Writer, step: Any) -> Any:
        place = f.builder.mul(f.builder.and_(step, f.mask), INTEGER(len(self.plan.lines)))
        return f.place(f.past, place)

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
            given = [f.arguments[word] for word in _OUTPUTS if word in f.arguments]
            for chunk in self._chunks("outputs", self.plan.calls, _OUTPUTS, self._output):
                good = f.builder.call(chunk, [*given, FLAG(1), strict], attrs=("noinline",))
                f.return_if(f.builder.not_(good), INTEGER(SUSPECT))
            self._fill(f)
        f.builder.ret(INTEGER(COMPLETED))

    def _output(self, f: Writer, call: Step) -> None:
        """Emit one call of a part's `output`; at the start, its `start` comes before."""
        b, index = f.builder, call.piece
        with nullcontext() if call.always else b.if_then(f.starting), self._timed(f, index):
            scratch = self._gather(f, index)
            if not call.last:
                self._stage(f, index, "output", scratch, f.strict)
            elif not call.always:
                self._begin(f, index, scratch)
            else:
                with b.if_else(f.starting, likely=False) as (at_the_start, running):
                    with at_the_start:
                        self._begin(f, index, scratch)
                    with running:
                        self._stage(f, index, "output", scratch, FLAG(1))

    def _begin(self, f: Writer, index: int, scratch: Any) -> None:
        piece = self.plan.pieces[index]
        given = [*self._own_tables(f, piece, scratch), *(f.arguments[word] for word in _BEGIN)]
        wrong = f.builder.not_(f.builder.call(self._beginning(piece), given, attrs=("noinline",)))
        f.return_if(f.builder.and_(f.strict, wrong), FLAG(0))

    def _beginning(self, piece: Piece) -> Any:
        """Emit the start of all parts of one kernel, up to the first failure. Values of the spec are set last."""
        name = f"{piece.kernel}.begin"
        if name not in self.names:
            words = {**dict.fromkeys("puxy", "pointer"), **{word: _OUTPUTS[word] for word in _BEGIN}}
            f = self._function(name, FLAG, words, apart=False)
            tables = [f.arguments[word] for word in "puxy"]
            if "start" in piece.stages:
                f.return_if(f.builder.call(self._kernel(piece, "start"), [*tables, f.dt]), FLAG(0))
            with f.times(f.count) as i:
                f.store(f.load(f.values, i), f.states, f.load(f.places, i, INTEGER))
            f.return_if(f.builder.not_(self._is_finite(f, f.x, len(piece.states))), FLAG(0))
            if "output" in piece.stages:
                f.return_if(f.builder.call(self._kernel(piece, "output"), [*tables, f.dt]), FLAG(0))
            f.builder.ret(self._is_finite(f, f.y, len(piece.outputs)))
        return self.names[name]

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

    def _read(self, f: Writer, tie: int, place: int) -> None:
        address = f.load(f.ties, tie, POINTER)
        f.store(f.load(address, 0), f.outputs, place)

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
        with self._timed(f, "second half"):
            self._advance(f)
        positions, velocities = plan.coordinates
        finite = self._is_finite(f, f.qpos, positions)
        followed = b.call(self.names["bounded"], [f.qvel, INTEGER(velocities), f.fastest], attrs=("noinline",))
        self._end_unless(f, b.and_(finite, followed), DIVERGED)

    def _look(self, f: Writer, unless: Callable[[Any, int], None]) -> None:
        """Emit the outputs at the present positions and velocities of MuJoCo."""
        b, plan = f.builder, self.plan
        with self._timed(f, "first half"):
            b.call(self._external("mj_step1", NOTHING, [POINTER, POINTER]), [f.model, f.data])
        for i, (place, moves) in enumerate(plan.reads):
            if moves:
                self._read(f, i, place)
        frame, nowhere = [f.arguments[word] for word in FRAME], ir.Constant(POINTER, None)
        for chunk in self._chunks("outputs", plan.calls, _OUTPUTS, self._output):
            given = [*frame, nowhere, nowhere, INTEGER(0), FLAG(0), FLAG(1)]
            unless(b.call(chunk, given, attrs=("noinline",)), SUSPECT)
        unless(self._table_is_finite(f, f.outputs, plan.outputs), SUSPECT)

    def _write(self, f: Writer) -> None:
        """Emit the forces and controls for MuJoCo."""
        b, plan = f.builder, self.plan
        for i, (of_outputs, place, sign) in enumerate(plan.writes):
            value = f.load(f.outputs, place) if of_outputs else self._arriving(f, place)
            value = b.fmul(value, DOUBLE(sign))
            if plan.runge_kutta:
                value = self._carried_on(f, i, value)
            b.store(value, f.load(f.ties, len(plan.reads) + i, POINTER))

    def _carried_on(self, f: Writer, number: int, value: Any) -> Any:
        """Emit a written value, extrapolated to the middle of the step. In the first step it is constant."""
        b, before = f.builder, f.load(f.written, number)
        f.store(value, f.written, number)
        carried = b.fsub(b.fmul(DOUBLE(1.5), value), b.fmul(DOUBLE(0.5), before))
        return b.select(b.fcmp_unordered("uno", before, before), value, carried)

    def _advance(self, f: Writer) -> None:
        """Emit the second half of MuJoCo's step."""
        if self.plan.guards:
            self._end_unless(f, Events(self).advance(f), SUSPECT)
            return
        if not self.plan.runge_kutta:
            f.builder.call(self._external("mj_step2", NOTHING, [POINTER, POINTER]), [f.model, f.data])
            return
        forward = self._external("mj_forwardSkip", NOTHING, [POINTER, POINTER, SHORT, SHORT])
        f.builder.call(forward, [f.model, f.data, SHORT(AFTER_VELOCITIES), SHORT(0)])
        advance = self._external("mj_RungeKutta", NOTHING, [POINTER, POINTER, SHORT])
        f.builder.call(advance, [f.model, f.data, SHORT(4)])

    def _table_is_finite(self, f: Writer, table: Any, size: int) -> Any:
        return f.builder.call(self.names["finite_padded"], [table, INTEGER(padded(size))])

    def _end_unless(self, f: Writer, good: Any, status: int) -> None:
        with f.builder.if_then(f.builder.not_(good), likely=False):
            f.builder.store(f.step, f.reached)
            f.builder.ret(INTEGER(status))

    def _chunks(
        self, name: str, calls: Sequence[Any], words: Mapping[str, str], write: Callable[[Writer, Any], None]
    ) -> Iterator[Any]:
        """Functions that make calls in order, a fixed number of calls each.

        Yields:
            The flag of success of each function.
        """
        for number, begin in enumerate(range(0, len(calls), _CHUNK)):
            chunk = f"{name}.{number}"
            if chunk not in self.names:
                f = self._function(chunk, FLAG, words)
                for call in calls[begin : begin + _CHUNK]:
                    write(f, call)
                f.builder.ret(FLAG(1))
            yield self.names[chunk]

    def _update(self, f: Writer, index: int) -> None:
        with self._timed(f, index):
            self._stage(f, index, "update", self._gather(f, index), FLAG(1))

    def _timed(self, f: Writer, what: int | str) -> AbstractContextManager[None]:  # noqa: ARG002
        """Around the code of a part or of a named section: `stopwatch` measures its time there."""
        return nullcontext()
