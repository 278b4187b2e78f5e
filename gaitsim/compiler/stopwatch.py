"""A plan in LLVM IR that measures how long each of its parts takes, in ticks of the processor's counter."""

from __future__ import annotations

import platform
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from llvmlite import ir

from gaitsim.compiler.native import CLOCK, TICKS, TIMED
from gaitsim.compiler.translation import Translation
from gaitsim.compiler.writer import DOUBLE, INTEGER, Writer

# On ARM, programs may read the system's counter only.
_COUNTER = "llvm.readsteadycounter" if platform.machine().lower() in ("arm64", "aarch64") else "llvm.readcyclecounter"


@dataclass
class TimedTranslation(Translation):
    """Adds times and numbers of intervals to `ticks`: of each part, of each stage of the mechanics, of reading the
    counter, and of all steps. Within a step no interval contains another one.

    `clock` returns the counter to MuJoCo's own timers.
    """

    def module(self) -> Any:
        """The whole module, with the table of ticks and the clock."""
        kind = ir.ArrayType(INTEGER, 2 * self._slots)
        ticks = ir.GlobalVariable(self.text, kind, TICKS)
        ticks.initializer = ir.Constant(kind, None)
        self.names[TICKS] = ticks
        self.names[_COUNTER] = ir.Function(self.text, ir.FunctionType(INTEGER, []), _COUNTER)
        clock = self._function(CLOCK, DOUBLE, {}, exported=True)
        clock.builder.ret(clock.builder.uitofp(self._now(clock), DOUBLE))
        return super().module()

    @property
    def _slots(self) -> int:
        return len(self.plan.pieces) + len(TIMED)

    def _one_step(self, f: Writer) -> None:
        with self._timed(f, "steps"):
            with self._timed(f, "reading"):
                pass
            super()._one_step(f)

    @contextmanager
    def _timed(self, f: Writer, what: int | str) -> Iterator[None]:
        before = self._now(f)
        yield
        slot = what if isinstance(what, int) else len(self.plan.pieces) + TIMED.index(what)
        taken = f.builder.sub(self._now(f), before)
        self._add(f, slot, taken)
        self._add(f, self._slots + slot, INTEGER(1))

    def _add(self, f: Writer, slot: int, number: Any) -> None:
        place = f.builder.gep(self.names[TICKS], [INTEGER(0), INTEGER(slot)], inbounds=True)
        f.builder.store(f.builder.add(f.builder.load(place), number), place)

    def _now(self, f: Writer) -> Any:
        return f.builder.call(self.names[_COUNTER], [])
