"""The part of a plan in LLVM IR that stores signals of each step in a row of the record."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from llvmlite import ir

from gaitsim.compiler.plan import Plan
from gaitsim.compiler.writer import INTEGER, NOTHING, POINTER, Writer


@dataclass(frozen=True)
class Records:
    """Writes functions into a module."""

    text: Any
    names: dict[str, Any]
    function: Callable[..., Writer]
    plan: Plan

    def copy(self) -> None:
        """Emit the copy of numbers of a table into a row, by pairs of target and origin."""
        arguments = {**dict.fromkeys(("row", "table", "pairs"), "pointer"), "count": "integer"}
        f = self.function("copy_pairs", NOTHING, arguments)
        with f.times(f.count) as i:
            pair = f.place(f.pairs, f.builder.mul(i, INTEGER(2)), INTEGER)
            value = f.load(f.table, f.load(pair, 1, INTEGER))
            f.store(value, f.row, f.load(pair, 0, INTEGER))
        f.builder.ret_void()

    def record(self, f: Writer) -> None:
        b, signals, size = f.builder, list(enumerate(self.plan.signals)), self.plan.outputs
        wanted = b.icmp_unsigned("!=", f.record, ir.Constant(POINTER, None))
        with b.if_then(wanted, likely=False):
            row = f.place(f.record, b.mul(f.step, INTEGER(len(signals))))
            self._keep(f, row, f.outputs, [(i, place) for i, place in signals if place < size])
            self._keep(f, row, f.states, [(i, place - size) for i, place in signals if place >= size])

    def _keep(self, f: Writer, row: Any, table: Any, pairs: list[tuple[int, int]]) -> None:
        kind = ir.ArrayType(INTEGER, 2 * len(pairs))
        constant = ir.GlobalVariable(self.text, kind, self.text.get_unique_name("pairs"))
        constant.linkage, constant.global_constant = "internal", True
        constant.initializer = ir.Constant(kind, [number for pair in pairs for number in pair])
        f.builder.call(self.names["copy_pairs"], [row, table, constant, INTEGER(len(pairs))])
