"""Functions in LLVM IR, as all that translates a plan writes them, and the tests of numbers that they call."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from typing import Any

from llvmlite import ir

from gaitsim.compiler.native import PADDING, padded
from gaitsim.compiler.plan import Plan
from gaitsim.compiler.writer import DOUBLE, FLAG, INTEGER, POINTER, SHORT, Writer

# Calls of parts in one function. The time of LLVM grows faster than the length of a function.
_CHUNK = 64

_LANES = ir.VectorType(DOUBLE, 8)
_KINDS = {"flag": FLAG, "integer": INTEGER, "number": DOUBLE, "pointer": POINTER, "shared": POINTER}


@dataclass
class Functions:
    """The module of a plan, with its functions by name."""

    plan: Plan
    text: Any = field(default_factory=lambda: ir.Module("program"))
    names: dict[str, Any] = field(default_factory=dict)

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

    def _chunks(
        self, name: str, calls: Sequence[Any], kinds: Mapping[str, str], write: Callable[[Writer, Any], None]
    ) -> Iterator[Any]:
        """Functions that make calls in order, a fixed number of calls each.

        Yields:
            The flag of success of each function.
        """
        for number, begin in enumerate(range(0, len(calls), _CHUNK)):
            chunk = f"{name}.{number}"
            if chunk not in self.names:
                f = self._function(chunk, FLAG, kinds)
                for call in calls[begin : begin + _CHUNK]:
                    write(f, call)
                f.builder.ret(FLAG(1))
            yield self.names[chunk]

    def _timed(self, f: Writer, what: int | str) -> AbstractContextManager[None]:  # noqa: ARG002
        """Around the code of a part or of a named section: `stopwatch` measures its time there."""
        return nullcontext()

    # --- tests of numbers ---

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

    def _table_is_finite(self, f: Writer, table: Any, size: int) -> Any:
        return f.builder.call(self.names["finite_padded"], [table, INTEGER(padded(size))])
