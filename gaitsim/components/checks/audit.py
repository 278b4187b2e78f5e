"""The audit of units: a component's functions are run on numbers that have a dimension and no value.

A comparison of such numbers has no result, so both branches are followed. Two paths that reach the same statement with
equal dimensions in all local variables continue as one. Consecutive ifs therefore add paths instead of multiplying
them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from gaitsim.component import Component, Input, Metric, Output, Parameter, Series, State
from gaitsim.components.checks.audit_names import namespace
from gaitsim.components.checks.check import SIGNATURES, parse, parse_shared
from gaitsim.components.checks.declaration import unit_rule
from gaitsim.components.checks.dimension_search import Field, Number, Record, Search
from gaitsim.components.checks.shared import Shared, builtins_with
from gaitsim.components.checks.statement_marks import mark_statements
from gaitsim.errors import Fault, InvalidComponent, Mark
from gaitsim.units import UnknownUnit, parse_unit

_KINDS = {"p": Parameter | Series, "u": Input, "x": State, "y": Output, "m": Metric}


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
        others = [parse_shared(other.text, other.display_path) for other in shared]
    except InvalidComponent as error:
        return Audit(error.faults, ())
    statements = mark_statements(tree, others)
    search = Search(file, {file: text.splitlines()} | {one.display_path: one.text.splitlines() for one in shared})
    space = namespace(search)
    try:
        spaces = {}
        for one, other in zip(shared, others, strict=True):
            spaces[one.name] = namespace(search)
            exec(compile(other, one.display_path, "exec"), spaces[one.name])
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


def _record(search: Search, component: type[Component], letter: str) -> Record:
    fields = {}
    for name, one in component.declarations.items():
        if isinstance(one, Parameter | Series | Input | State | Output | Metric):
            if not isinstance(one, _KINDS[letter]):
                continue
            unit = parse_unit(one.unit)
            size = one.size if isinstance(one, State | Series) else None
            dimension = search.dimensions.one(unit.dimension)
            fields[name] = Field(f"{letter}.{name}", unit, dimension, size)
    return Record(search, letter, fields)
