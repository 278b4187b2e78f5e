"""Parameters that a signal sets: the same component, with these parameters as inputs."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator
from dataclasses import replace
from functools import cache

from gaitsim.component import Input, Output, State
from gaitsim.components.checks.check import class_functions, parse, parse_shared
from gaitsim.components.checks.findings import findings_of
from gaitsim.components.ieee import ieee_math
from gaitsim.components.load import component_class, execute
from gaitsim.components.primitive import Primitive

_LATE = {"build": "when the mechanics are built", "finish": "after the run"}


def obstacle(component: Primitive, name: str, common: Collection[str] = ()) -> str:
    """Why a signal cannot set a parameter of a component; empty if it can.

    Args:
        component: The component.
        name: The parameter.
        common: The parameters that every component of its kind has.
    """
    if name in common or component.kind == "measure":
        return f"figures and metrics rely on the number {name} of a {component.kind}"
    if component.parameters[name].whole:
        return f"{name} is a whole number, such as a count"
    functions = class_functions(parse(component.text, component.display_path))
    for word, function in functions.items():
        reads = list(_reads(function, name))
        if word in _LATE and reads:
            return f"{component.reference} reads {name} {_LATE[word]}"
        if any(isinstance(node, ast.Call) for node in reads):
            return f"{component.reference} hands all of its parameters to a function"
    declared = component.cls.declarations.values()
    ends = [end for one in declared if isinstance(one, Input | Output | State) for end in _ends(one)]
    given = [text for part in component.parts.values() for _, text in part.gives]
    if any(_names(text, name) for text in given):
        return f"{component.reference} computes numbers of an inner part from {name}"
    if any(_names(end, name) for end in ends):
        return f"{component.reference} has a range at the start that depends on {name}"
    return ""


@cache
def driven(component: Primitive, names: frozenset[str]) -> Primitive:
    """The component with some of its parameters as inputs.

    Only the letter before their names changes in its text, so that places in it stay what they are.

    Args:
        component: The component.
        names: Parameters without an obstacle.
    """
    text = _rewritten(component, names)
    cls = component_class(execute(text, component.display_path, ieee_math(), component.shared))
    cls.declarations = {
        name: Input(one.unit, one.doc, possible=one.bounds) if name in names else one  # type: ignore[union-attr]
        for name, one in cls.declarations.items()
    }
    others = [parse_shared(file.text, file.display_path) for file in component.shared]
    findings = findings_of(parse(text, component.display_path), cls.declarations, others)
    return replace(component, text=text, cls=cls, findings=findings)


def _rewritten(component: Primitive, names: frozenset[str]) -> str:
    lines = [line.encode() for line in component.text.splitlines(keepends=True)]
    for function in class_functions(parse(component.text, component.display_path)).values():
        for name in names:
            for node in _reads(function, name):
                line, at = lines[node.lineno - 1], node.col_offset
                lines[node.lineno - 1] = line[:at] + b"u" + line[at + 1 :]
    return b"".join(lines).decode()


def _reads(function: ast.FunctionDef, name: str) -> Iterator[ast.expr]:
    """Where a function reads a parameter, and where it hands on all parameters."""
    for node in ast.walk(function):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            if node.value.id == "p" and node.attr == name:
                yield node
        elif isinstance(node, ast.Call) and any(isinstance(a, ast.Name) and a.id == "p" for a in node.args):
            yield node


def _ends(one: Input | Output | State) -> Iterator[str]:
    """The expressions in the ranges of a signal at the start."""
    for ends in (one.usual, one.possible):
        yield from (end for end in ends or () if isinstance(end, str))


def _names(text: str, name: str) -> bool:
    return any(isinstance(node, ast.Name) and node.id == name for node in ast.walk(ast.parse(text, mode="eval")))
