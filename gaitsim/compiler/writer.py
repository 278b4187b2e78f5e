"""A writer of functions in LLVM IR: numbers in tables, loops, early returns."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from llvmlite import ir

INTEGER, SHORT, FLAG = ir.IntType(64), ir.IntType(32), ir.IntType(1)
DOUBLE, POINTER, NOTHING = ir.DoubleType(), ir.PointerType(), ir.VoidType()


@dataclass
class Writer:
    """One function: the position of its next instruction, and its arguments by name."""

    builder: Any
    arguments: dict[str, Any]

    def __getattr__(self, name: str) -> Any:
        return self.arguments[name]

    def place(self, table: Any, place: Any, kind: Any = DOUBLE) -> Any:
        """The address of a number in a table."""
        index = place if isinstance(place, ir.Value) else INTEGER(place)
        return self.builder.gep(table, [index], inbounds=True, source_etype=kind)

    def load(self, table: Any, place: Any, kind: Any = DOUBLE) -> Any:
        """A number of a table."""
        return self.builder.load(self.place(table, place, kind), typ=kind)

    def store(self, value: Any, table: Any, place: Any) -> None:
        """Set a number of a table."""
        self.builder.store(value, self.place(table, place))

    @contextmanager
    def times(self, count: Any, step: int = 1, first: int = 0) -> Iterator[Any]:
        """A loop over first, first + step ... below a count."""
        b = self.builder
        before, loop, done = b.block, b.append_basic_block("loop"), b.append_basic_block("done")
        b.cbranch(b.icmp_signed("<", INTEGER(first), count), loop, done)
        b.position_at_end(loop)
        index = b.phi(INTEGER)
        index.add_incoming(INTEGER(first), before)
        yield index
        following = b.add(index, INTEGER(step))
        index.add_incoming(following, b.block)
        b.cbranch(b.icmp_signed("<", following, count), loop, done)
        b.position_at_end(done)

    def return_if(self, flag: Any, value: Any) -> None:
        """Return from the function if a flag is set, which is unlikely."""
        with self.builder.if_then(flag, likely=False):
            self.builder.ret(value)
