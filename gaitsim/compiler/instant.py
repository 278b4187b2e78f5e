"""One instant of a plan in LLVM IR: the outputs of all parts, and what they write into MuJoCo."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from contextlib import nullcontext
from functools import cached_property
from typing import Any

from llvmlite import ir

from gaitsim.compiler.functions import Functions
from gaitsim.compiler.kernel import STAGES
from gaitsim.compiler.mujoco_step import MujocoStep
from gaitsim.compiler.native import FRAME, SUSPECT
from gaitsim.compiler.plan import Piece, Step
from gaitsim.compiler.writer import DOUBLE, FLAG, INTEGER, POINTER, SHORT, Writer

# Kernels of more parts than this are called instead of inlined, so that their code stays in the cache.
_COPIES = 3
# Arguments of the functions that call `output` of all parts, at the start and later, and of starting a part.
OUTPUTS = {**FRAME, "places": "pointer", "values": "pointer", "count": "integer", "starting": "flag", "strict": "flag"}
_BEGIN = ("dt", "states", "places", "values", "count")


class Instant(Functions):
    """Functions of the parts, called in the order of the plan."""

    @cached_property
    def users(self) -> Counter[str]:
        """The number of parts of each kernel."""
        return Counter(piece.kernel for piece in self.plan.pieces)

    def _look(self, f: Writer, unless: Callable[[Any, int], None]) -> None:
        """Emit the outputs at the present positions and velocities of MuJoCo."""
        b, plan = f.builder, self.plan
        MujocoStep(self).look(f)
        for i, (place, moves) in enumerate(plan.reads):
            if moves:
                self._read(f, i, place)
        frame, nowhere = [f.arguments[word] for word in FRAME], ir.Constant(POINTER, None)
        for chunk in self._chunks("outputs", plan.calls, OUTPUTS, self._output):
            given = [*frame, nowhere, nowhere, INTEGER(0), FLAG(0), FLAG(1)]
            unless(b.call(chunk, given, attrs=("noinline",)), SUSPECT)
        unless(self._table_is_finite(f, f.outputs, plan.outputs), SUSPECT)

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

    def _read(self, f: Writer, tie: int, place: int) -> None:
        address = f.load(f.ties, tie, POINTER)
        f.store(f.load(address, 0), f.outputs, place)

    # --- one part ---

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

    def _begin(self, f: Writer, index: int, scratch: Any) -> None:
        piece = self.plan.pieces[index]
        given = [*self._own_tables(f, piece, scratch), *(f.arguments[word] for word in _BEGIN)]
        wrong = f.builder.not_(f.builder.call(self._beginning(piece), given, attrs=("noinline",)))
        f.return_if(f.builder.and_(f.strict, wrong), FLAG(0))

    def _beginning(self, piece: Piece) -> Any:
        """Emit the start of all parts of one kernel, up to the first failure. Values of the spec are set last."""
        name = f"{piece.kernel}.begin"
        if name not in self.names:
            kinds = {**dict.fromkeys("puxy", "pointer"), **{word: OUTPUTS[word] for word in _BEGIN}}
            f = self._function(name, FLAG, kinds, apart=False)
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

    # --- inputs ---

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
