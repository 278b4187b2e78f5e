"""Numbers with a dimension and no value, and the search along all paths of a function that is run on them."""

from __future__ import annotations

import dis
import math
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import FrameType
from typing import Any

from gaitsim.components.checks.check import place
from gaitsim.errors import Faults, Mark
from gaitsim.units import Dimension, Unit

_DECISIONS = 40  # on one path; only a loop over plain numbers comes near
_PATHS = 2000  # of one function
_STATEMENTS = 50_000  # of one function, over all its paths
_RAISE = dis.opmap["RAISE_VARARGS"]


def _operator(text: str, swapped: bool = False, keeps: bool = True) -> Callable[[Number, Any], Number]:
    """An operator that needs operands of equal dimension."""

    def operator(self: Number, other: Any) -> Number:
        pair = (other, self) if swapped else (self, other)
        return self.search.alike(text, *pair, keeps=keeps)

    return operator


class Number:
    """A number without a value. It has a dimension, and a chosen answer when it is used as a condition."""

    __slots__ = ("answer", "dimension", "search")
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, search: Search, dimension: Dimension) -> None:
        self.search, self.dimension = search, dimension
        self.answer: bool | None = None

    def __bool__(self) -> bool:
        if self.answer is None:
            self.answer = self.search.decide()
        return self.answer

    def __index__(self) -> int:
        self.search.plain("an index", self)
        return 0

    def __neg__(self) -> Number:
        return Number(self.search, self.dimension)

    __pos__ = __abs__ = __neg__

    def __round__(self, digits: Any = None) -> Number:
        return self.search.plain("round", self)

    __add__ = _operator("adds {0} to {1}")
    __radd__ = _operator("adds {0} to {1}", swapped=True)
    __sub__ = _operator("subtracts {1} from {0}")
    __rsub__ = _operator("subtracts {1} from {0}", swapped=True)
    __mod__ = _operator("takes {0} modulo {1}")
    __rmod__ = _operator("takes {0} modulo {1}", swapped=True)
    __floordiv__ = _operator("takes whole parts of {0} by {1}", keeps=False)
    __rfloordiv__ = _operator("takes whole parts of {0} by {1}", swapped=True, keeps=False)
    __lt__ = __le__ = __gt__ = __ge__ = _operator("compares {0} with {1}", keeps=False)
    __eq__ = __ne__ = __lt__  # type: ignore[assignment]

    def __mul__(self, other: Any) -> Any:
        return self.search.combine("*", self, other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        return self.search.combine("/", self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return self.search.combine("/", other, self)

    def __pow__(self, other: Any) -> Number:
        return self.search.power(self, other)

    def __rpow__(self, other: Any) -> Number:
        return self.search.power(other, self)


class Record:
    """One of p, u, x, y and m: numbers by name, each with the declared unit."""

    _search: Search
    _letter: str
    _fields: dict[str, Field]

    def __init__(self, search: Search, letter: str, fields: dict[str, Field]) -> None:
        vars(self).update(_search=search, _letter=letter, _fields=fields)

    def __getattr__(self, name: str) -> Number | Array:
        field = self._field(name)
        if field.size is not None:
            return Array(self._search, field)
        return Number(self._search, field.dimension)

    def __setattr__(self, name: str, value: Any) -> None:
        field = self._field(name)
        if field.size is not None:
            raise TypeError(f"{field.name} is {field.size} numbers; assign {field.name}[i]")
        self._search.expect(field, value)

    def _field(self, name: str) -> Field:
        if name not in self._fields:
            raise AttributeError(f"{self._letter}.{name} is not declared")
        return self._fields[name]


@dataclass(frozen=True)
class Field:
    name: str
    unit: Unit
    dimension: Dimension
    size: int | None


class Array:
    """A state of several numbers of one unit."""

    def __init__(self, search: Search, field: Field) -> None:
        self.search, self.field = search, field

    def __len__(self) -> int:
        return self.field.size or 0

    def __getitem__(self, index: Any) -> Number:
        self.search.plain("an index", index)
        return Number(self.search, self.field.dimension)

    def __setitem__(self, index: Any, value: Any) -> None:
        self.search.plain("an index", index)
        self.search.expect(self.field, value)

    def __iter__(self) -> Iterator[Number]:
        return iter([self[0] for _ in range(min(len(self), 2))])


class _End(BaseException):
    """Raised to leave a path that need not be followed further."""


class _Dimensions:
    """Keeps one object for equal dimensions, because hashing fractions is slow."""

    def __init__(self) -> None:
        self._known: dict[Dimension, Dimension] = {}
        self._results: dict[tuple[int, str, int | float], Dimension] = {}
        self.plain = self.one(Dimension())

    def one(self, dimension: Dimension) -> Dimension:
        seen = dimension.without_angle
        return self._known.setdefault(seen, seen)

    def combined(self, sign: str, left: Dimension, right: Dimension) -> Dimension:
        key = (id(left), sign, id(right))
        if key not in self._results:
            self._results[key] = self.one(left * right if sign == "*" else left / right)
        return self._results[key]

    def powered(self, base: Dimension, exponent: float) -> Dimension:
        key = (id(base), "**", exponent)
        if key not in self._results:
            self._results[key] = self.one(base**exponent)
        return self._results[key]


class Search:
    """Follows the paths through a function. Each path is a list of decisions, which is replayed and then extended."""

    def __init__(self, file: str, texts: Mapping[str, Sequence[str]]) -> None:
        self.file, self.texts, self.faults = file, texts, Faults()
        self.dimensions = _Dimensions()
        self.reached: set[int] = set()
        self.complete = True
        self.entry: Any = None
        self.script: list[bool] = []
        self.taken: list[bool] = []
        self.turns: list[int] = []
        self.seen: set[Any] = set()
        self.statements = 0

    def explore(self, function: Callable[..., None], arguments: list[Any]) -> None:
        """Follow every path of a function, depth first."""
        self.entry, self.seen, self.statements = function.__code__, set(), 0
        scripts: list[list[bool]] = [[]]
        for _ in range(_PATHS):
            if not scripts or self.statements > _STATEMENTS:
                break
            self.script, self.taken, self.turns = scripts.pop(), [], []
            try:
                function(*arguments)
            except _End:
                pass
            except Exception as error:
                self.trip(error)
            new = range(len(self.script), len(self.taken))
            scripts += [[*self.taken[:at], not self.taken[at]] for at in new]
        self.complete &= not scripts

    def decide(self) -> bool:
        at = len(self.taken)
        if at >= _DECISIONS:
            self.complete = False
            raise _End
        self.taken.append(self.script[at] if at < len(self.script) else False)
        return self.taken[at]

    def reach(self, statement: int) -> None:
        """Called before each statement. Ends the path if an equal one was here before."""
        self.reached.add(statement)
        self.statements += 1
        if self.statements > _STATEMENTS:
            self.complete = False
            raise _End
        frame = sys._getframe(1)
        if frame.f_code is not self.entry or len(self.taken) < len(self.script):
            return
        local = tuple((name, _shape(value)) for name, value in frame.f_locals.items())
        key = (statement, tuple(self.turns), local)
        if key in self.seen:
            raise _End
        self.seen.add(key)

    def each(self, values: Iterable[Any]) -> Iterator[Any]:
        """The iterations of a for loop. Paths in different iterations are never equal."""
        depth = len(self.turns)
        self.turns.append(0)
        for turn, value in enumerate(values):
            self.turns[depth:] = [turn]
            yield value
        del self.turns[depth:]

    def dimension(self, value: Any) -> Dimension | None:
        """The dimension of an operand; None for 0, inf and nan, which fit every dimension."""
        if isinstance(value, Number):
            return value.dimension
        if not isinstance(value, int | float):
            raise TypeError(f"a number is needed here, not {type(value).__name__}")
        return self.dimensions.plain if value and math.isfinite(value) else None

    def alike(self, text: str, *values: Any, keeps: bool = True) -> Number:
        """Check that all values have one dimension.

        Returns:
            A number of that dimension, or a plain number unless `keeps`.
        """
        found = [d for d in map(self.dimension, values) if d is not None]
        other = next((d for d in found if d is not found[0]), None)
        if other is not None:
            self.fault(text.format(found[0], other) + ".")
        return Number(self, found[0] if found and keeps else self.dimensions.plain)

    def combine(self, sign: str, left: Any, right: Any) -> Any:
        if self.dimension(left) is None:  # 0 times a force still fits any dimension
            self.dimension(right)
            return left
        if sign == "*" and self.dimension(right) is None:
            return right
        plain = self.dimensions.plain
        a, b = self.dimension(left) or plain, self.dimension(right) or plain
        return Number(self, self.dimensions.combined(sign, a, b))

    def power(self, base: Any, exponent: Any) -> Number:
        dimension = self.dimension(base) or self.dimensions.plain
        if not isinstance(exponent, Number):
            self.dimension(exponent)
            return Number(self, self.dimensions.powered(dimension, exponent))
        if not dimension.plain:
            self.fault(f"{dimension} can only be raised to a literal power.")
        return self.plain("a power", exponent)

    def plain(self, what: str, *values: Any) -> Number:
        """A plain number, computed from values that must be plain."""
        for value in values:
            dimension = self.dimension(value)
            if dimension is not None and not dimension.plain:
                self.fault(f"{what} needs a plain number; this is {dimension}.")
        return Number(self, self.dimensions.plain)

    def expect(self, field: Field, value: Any) -> None:
        given = self.dimension(value)
        if given is not None and given is not field.dimension:
            declared = f"{field.name} is declared in {field.unit.text} ({field.unit.noun_phrase})"
            self.fault(f"{declared}; this gives {given} ({given.si}).")

    def fault(self, message: str) -> None:
        frame: FrameType | None = sys._getframe(1)
        while frame is not None and frame.f_code.co_filename not in self.texts:
            frame = frame.f_back
        mark = self.mark(frame.f_code, frame.f_lasti) if frame else Mark(self.file)
        self.faults.add(message, mark)

    def mark(self, code: Any, instruction: int) -> Mark:
        """The place of an instruction in the file."""
        line, _, offset, _ = list(code.co_positions())[instruction // 2]
        return place(code.co_filename, self.texts[code.co_filename], line or 0, offset or 0)

    def trip(self, error: Exception) -> None:
        """Report an exception, unless the component itself raised it."""
        trace, mark, raised = error.__traceback__, Mark(self.file), False
        while trace is not None:
            code = trace.tb_frame.f_code
            raised = False
            if code.co_filename in self.texts:
                mark = self.mark(code, trace.tb_lasti)
                raised = code.co_code[trace.tb_lasti] == _RAISE
            trace = trace.tb_next
        if isinstance(error, UnboundLocalError):
            name = str(error).split("'")[1]
            self.faults.add(f"{name} is not set on every path that leads here.", mark)
        elif not raised:
            reason = f"{type(error).__name__}: {error}"
            self.faults.add(f"the check of units cannot run this ({reason}).", mark)


def _shape(value: Any) -> Any:
    """What distinguishes two values of a local variable for the audit."""
    if isinstance(value, Number):
        return (id(value.dimension), value.answer)
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, Record):
        return id(value)
    if isinstance(value, Array):
        return value.field.name
    if isinstance(value, tuple):
        return tuple(map(_shape, value))
    return object()
