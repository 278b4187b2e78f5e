"""Calls before each statement of a component file, by which an audit knows which statements it has reached."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence

from gaitsim.components.checks.check import class_functions


def mark_statements(tree: ast.Module, others: Sequence[ast.Module]) -> Mapping[int, int]:
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
