"""The audit of units: a component's functions are run on numbers that have a dimension and no value.

A comparison of such numbers has no result, so both branches are followed. Two paths that reach the same statement with
equal dimensions in all local variables continue as one. Consecutive ifs therefore add paths instead of multiplying
them.
"""

from __future__ import annotations

import ast
import builtins
import dis
import math
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import FrameType, SimpleNamespace
from typing import Any

from gaitsim.component import Component, Input, Metric, Output, Parameter, Series, State
from gaitsim.components.checks.check import SIGNATURES, class_functions, parse, parse_shared, place
from gaitsim.components.checks.declaration import unit_rule
from gaitsim.components.checks.shared import Shared, builtins_with
from gaitsim.errors import Fault, Faults, InvalidComponent, Mark
from gaitsim.units import Dimension, Unit, UnknownUnit, parse_unit

_DECISIONS = 40  # on one path; only a loop that counts in plain numbers comes near
_PATHS = 2000  # of one function
_STATEMENTS = 50_000  # of one function, over all its paths
_RAISE = dis.opmap["RAISE_VARARGS"]
_KINDS = {"p": Parameter | Series, "u": Input, "x": State, "y": Output, "m": Metric}
# The unit of the result follows from the arguments; all other functions are plain to plain.
_ALIKE = {"hypot": True, "fmod": True, "remainder": True, "atan2": False, "isclose": False}
_ROOTS = {"sqrt": 1 / 2, "cbrt": 1 / 3}
_ANY_TO_PLAIN = {"isnan", "isinf", "isfinite"}
_FIRST = {"fabs", "copysign"}


@dataclass(frozen=True)
class Audit:
    """The result of an audit: faults, lines that no path reached, and whether all paths were run."""

    faults: tuple[Fault, ...]
    unreached: tuple[int, ...]
    complete: bool = True


def audit(text: str, file: str, shared: Sequence[Shared] = ()) -> Audit:
    """Run every function of a component file on dimensions, along every path.

    Args:
        text: The text of the component file.
        file: The name of the file in messages.
        shared: The shared files that it imports from; their functions are followed too.
    """
    try:
        tree = parse(text, file)
        others = [parse_shared(other.text, other.shown) for other in shared]
    except InvalidComponent as error:
        return Audit(error.faults, ())
    statements = _mark_statements(tree, others)
    search = _Search(file, {file: text.splitlines()} | {one.shown: one.text.splitlines() for one in shared})
    space = _namespace(search)
    try:
        spaces = {}
        for one, other in zip(shared, others, strict=True):
            spaces[one.name] = _namespace(search)
            exec(compile(other, one.shown, "exec"), spaces[one.name])
        space["__builtins__"] = builtins_with(spaces, space["__builtins__"])
        exec(compile(tree, file, "exec"), space)
    except Exception as error:
        search.trip(error)
        return Audit(tuple(search.faults.found), ())
    classes = [value for value in space.values() if isinstance(value, type)]
    component = next(c for c in classes if issubclass(c, Component) and c is not Component)
    try:
        records = {letter: _record(search, component, letter) for letter in _KINDS}
    except UnknownUnit as error:
        return Audit((Fault(unit_rule(str(error)), Mark(file)),), ())
    for name, letters in SIGNATURES.items():
        function: Any = getattr(component, name, None)
        if hasattr(function, "__code__") and name != "build":
            time = search.dimensions.one(parse_unit("s").dimension)
            search.explore(function, [records.get(a) or Number(search, time) for a in letters])
    unreached = {line for number, line in statements.items() if number not in search.reached}
    faults = sorted(search.faults.found, key=_line_and_column)
    return Audit(tuple(faults), tuple(sorted(unreached)), search.complete)


def _line_and_column(fault: Fault) -> tuple[int, int]:
    return (fault.mark.line, fault.mark.column) if fault.mark else (0, 0)


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

    def __init__(self, search: _Search, dimension: Dimension) -> None:
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

    _search: _Search
    _letter: str
    _fields: dict[str, _Field]

    def __init__(self, search: _Search, letter: str, fields: dict[str, _Field]) -> None:
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

    def _field(self, name: str) -> _Field:
        if name not in self._fields:
            raise AttributeError(f"{self._letter}.{name} is not declared")
        return self._fields[name]


@dataclass(frozen=True)
class _Field:
    name: str
    unit: Unit
    dimension: Dimension
    size: int | None


class Array:
    """A state of several numbers of one unit."""

    def __init__(self, search: _Search, field: _Field) -> None:
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


class _Search:
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
        if self.dimension(left) is None:  # nothing times a force still fits any dimension
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

    def expect(self, field: _Field, value: Any) -> None:
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
            said = f"{type(error).__name__}: {error}"
            self.faults.add(f"the audit cannot run this ({said}).", mark)


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


def _record(search: _Search, component: type[Component], letter: str) -> Record:
    fields = {}
    for name, one in component.declarations.items():
        if isinstance(one, Parameter | Series | Input | State | Output | Metric):
            if not isinstance(one, _KINDS[letter]):
                continue
            unit = parse_unit(one.unit)
            size = one.size if isinstance(one, State | Series) else None
            dimension = search.dimensions.one(unit.dimension)
            fields[name] = _Field(f"{letter}.{name}", unit, dimension, size)
    return Record(search, letter, fields)


def _namespace(search: _Search) -> dict[str, Any]:
    """The global names of an audited file: its math, and the builtins that depend on values."""

    def without_value(plain: Callable[..., Any], blind: Callable[..., Any]) -> Callable[..., Any]:
        def called(*values: Any) -> Any:
            return (blind if any(isinstance(v, Number) for v in values) else plain)(*values)

        return called

    def rule(name: str) -> Callable[..., Any]:
        said = f"math.{name}"
        if name in _ALIKE:
            return lambda *v: search.alike(f"{said} of {{0}} and {{1}}", *v, keeps=_ALIKE[name])
        if name in _ROOTS:
            return lambda v: search.power(v, _ROOTS[name])
        if name == "pow":
            return search.power
        if name in _ANY_TO_PLAIN:
            return lambda v: Number(search, search.dimensions.plain)
        if name in _FIRST:
            return lambda v, *sign: search.combine("*", v, 1)
        return lambda *v: search.plain(said, *v)

    def turns(*values: Any) -> list[Number]:
        return [search.plain("range", *values) for _ in range(2)]

    def concrete(*values: int) -> list[Number]:
        return [search.plain("range") for _ in range(*values)[:2]]

    def extreme(name: str) -> Callable[..., Any]:
        def blind(*v: Any) -> Number:
            return search.alike(f"takes the {name} of {{0}} and {{1}}", *v)

        return without_value(getattr(builtins, name), blind)

    def find(name: str, *rest: Any) -> Any:
        return mathematics if name == "math" else builtins.__import__(name, *rest)

    names = {n: v for n, v in vars(math).items() if not n.startswith("_")}
    mathematics = SimpleNamespace(**{n: without_value(v, rule(n)) if callable(v) else v for n, v in names.items()})
    own = {
        "__import__": find,
        "range": without_value(concrete, turns),
        "int": without_value(int, lambda v: search.plain("int", v)),
        "float": without_value(float, lambda v: search.combine("*", v, 1)),
        "min": extreme("min"),
        "max": extreme("max"),
        "print": lambda *values, **options: None,
        "breakpoint": lambda: None,
    }
    return {
        "__name__": "audited",
        "__builtins__": {**vars(builtins), **own},
        "__reach__": search.reach,
        "__each__": search.each,
    }


def _mark_statements(tree: ast.Module, others: Sequence[ast.Module]) -> Mapping[int, int]:
    """Insert a call before each statement of a function.

    Functions that only build() uses are left out, because build() works on MuJoCo and not on numbers.

    Args:
        others: The syntax trees of shared files. Their lines are not counted as unreached, because each component uses
            a part of them.

    Returns:
        The line of each inserted call in the component, by its number.
    """
    own = class_functions(tree)
    theirs = {node.name: node for other in others for node in other.body if isinstance(node, ast.FunctionDef)}
    mine = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    helpers = theirs | mine
    build = own.pop("build", None)
    only_build = _used(build, helpers) - _used(ast.Module(list(own.values()), []), helpers)
    numbers: dict[int, int] = {}
    for function in (*own.values(), *(node for name, node in mine.items() if name not in only_build)):
        _mark(function, numbers)
    lines = dict(numbers)
    for name, node in theirs.items():
        if name not in only_build:
            _mark(node, numbers)
    for each in (tree, *others):
        ast.fix_missing_locations(each)
    return lines


def _mark(function: ast.FunctionDef, lines: dict[int, int]) -> None:
    """Insert a call before each statement of a function, and around the iterable of each loop."""
    for node in list(ast.walk(function)):
        if isinstance(node, ast.For):
            node.iter = _call("__each__", node.iter, node.iter)
        for field in ("body", "orelse", "finalbody"):
            block = getattr(node, field, None)
            if isinstance(block, list):
                setattr(node, field, list(_with_marks(block, lines)))


def _with_marks(block: list[ast.stmt], lines: dict[int, int]) -> Iterator[ast.stmt]:
    for statement in block:
        docstring = isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
        if isinstance(statement, ast.stmt) and not docstring:
            lines[len(lines)] = statement.lineno
            number = ast.copy_location(ast.Constant(len(lines) - 1), statement)
            yield ast.copy_location(ast.Expr(_call("__reach__", number, statement)), statement)
        yield statement


def _call(name: str, argument: ast.expr, at: ast.AST) -> ast.Call:
    function = ast.copy_location(ast.Name(name, ast.Load()), at)
    return ast.copy_location(ast.Call(function, [argument], []), at)


def _used(node: ast.AST | None, helpers: Mapping[str, ast.FunctionDef]) -> set[str]:
    """The helpers that a function calls, directly or through others."""
    found: set[str] = set()
    todo = [node] if node is not None else []
    while todo:
        names = {n.id for n in ast.walk(todo.pop()) if isinstance(n, ast.Name)} & set(helpers)
        todo += [helpers[name] for name in names - found]
        found |= names
    return found
