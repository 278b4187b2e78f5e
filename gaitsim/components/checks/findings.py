"""What the syntax of a component file says of its functions: what outputs depend on, and how a call may end."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from gaitsim.component import Declaration
from gaitsim.components.checks.check import class_functions
from gaitsim.components.checks.dependency import output_dependencies

_IN_PYTHON = ("finish", "build")  # these never become native code


@dataclass(frozen=True)
class Findings:
    """What is known of the functions of a component. Where the text does not decide, the answer is the safe one.

    Attributes:
        dependencies: The inputs that each output needs.
        may_raise: Whether a function raises, asserts or indexes.
        open_loop: Whether a loop ends at a condition or after a computed number of iterations, so that it may not end
            on numbers that are not finite.
    """

    dependencies: Mapping[str, frozenset[str]]
    may_raise: bool
    open_loop: bool


def findings_of(
    tree: ast.Module, declarations: Mapping[str, Declaration], shared: Sequence[ast.Module] = ()
) -> Findings:
    """Read a component file.

    Args:
        tree: The file.
        declarations: The declarations of its class.
        shared: The files that it imports from.
    """
    nodes = [*_native_code(tree, shared)]
    return Findings(
        output_dependencies(tree, declarations, shared),
        any(isinstance(node, ast.Raise | ast.Assert | ast.Subscript) for node in nodes),
        any(_is_open(node) for node in nodes),
    )


def _native_code(tree: ast.Module, shared: Sequence[ast.Module]) -> Iterator[ast.AST]:
    """Everything within functions that become native code."""
    own = [function for name, function in class_functions(tree).items() if name not in _IN_PYTHON]
    helpers = [node for file in (tree, *shared) for node in file.body if isinstance(node, ast.FunctionDef)]
    for function in (*own, *helpers):
        for statement in function.body:
            yield from ast.walk(statement)


def _is_open(node: ast.AST) -> bool:
    """Whether a node is a loop of which the text does not say how often it runs."""
    if isinstance(node, ast.For | ast.comprehension):
        return not _is_counted(node.iter)
    return isinstance(node, ast.While)


def _is_counted(iterated: ast.expr) -> bool:
    """Whether this is a range of plain numbers."""
    match iterated:
        case ast.Call(func=ast.Name(id="range"), args=ends):
            return all(isinstance(_unsigned(end), ast.Constant) for end in ends)
        case _:
            return False


def _unsigned(number: ast.expr) -> ast.expr:
    return number.operand if isinstance(number, ast.UnaryOp) else number
