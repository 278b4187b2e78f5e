"""Expressions such as `=0.245 * height`: they may use parameters of their own file, and their units are checked."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from types import CodeType
from typing import Any

from gaitsim.errors import did_you_mean
from gaitsim.units import Dimension, parse_unit

_PLAIN = Dimension()
_FUNCTIONS: dict[str, Callable[..., float]] = {
    "sqrt": math.sqrt,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "exp": math.exp,
    "log": math.log,
    "abs": abs,
    "min": min,
    "max": max,
}
_CONSTANTS = {"pi": math.pi}
_Scope = Mapping[str, tuple[int, str]]  # the index of the number, and its unit, by name
_RULE = "an expression contains only numbers, parameters of its file, + - * / ** and functions; remove the rest."


class BadExpression(ValueError):
    """An expression is not valid; the text says why."""


@dataclass(frozen=True)
class Expression:
    """A checked expression: its text, its code, and the numbers that it reads, by name."""

    text: str
    code: CodeType
    names: tuple[tuple[str, int], ...]

    def value(self, numbers: list[float]) -> float:
        """Compute the expression.

        Args:
            numbers: All numbers of the model before this one, in SI.

        Raises:
            ArithmeticError: The expression has no value.
            ValueError: The expression has no value.
        """
        scope: dict[str, Any] = {name: numbers[index] for name, index in self.names}
        value = eval(self.code, {"__builtins__": {}, **_FUNCTIONS, **_CONSTANTS}, scope)
        if isinstance(value, complex):
            raise ArithmeticError("a root of a negative number")
        return float(value)


def parse_expression(text: str, unit: str, scope: _Scope) -> Expression:
    """Read and check an expression.

    Args:
        text: The expression without the `=`.
        unit: The unit that the result must have.
        scope: The parameters that it may name: the index of the number, and its unit.

    Raises:
        BadExpression: It cannot be read, names something else, or has another unit.
    """
    tree, variables = _parsed(text)
    found = _dimension(tree.body, scope, text)
    declared = parse_unit(unit).dimension
    if declared.without_angle != found and unit != "*" and not _open(found):
        raise BadExpression(f"={text} gives {found}; this needs {declared}, so multiply or divide by what is missing.")
    names = tuple((name, scope[name][0]) for name in variables if name in scope)
    return Expression(f"={text}", _code(text), names)


@cache
def _code(text: str) -> CodeType:
    """The code of an expression that was found valid."""
    return compile(_parsed(text)[0], "<expression>", "eval")


@cache
def _parsed(text: str) -> tuple[ast.Expression, tuple[str, ...]]:
    """The syntax tree of an expression, and all names in it, sorted. Its integers become floats, because powers of
    integers can grow without limit.
    """
    if not text.strip():
        raise BadExpression("there is no expression after the =; write such as =0.5 * height.")
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        if re.search(r"\d\s+[A-Za-z%]", text):
            rule = f"={text}: a number in an expression has no unit; declare it under parameters: and use its name."
            raise BadExpression(rule) from error
        reason = getattr(error, "msg", None) or "it is nested too deeply"
        raise BadExpression(f"={text} cannot be read ({reason}); write it like =0.5 * height.") from error
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and type(node.value) is int:
            try:
                node.value = float(node.value)
            except OverflowError as error:
                raise BadExpression(f"={text} has a number that is too large; write one below 1.8e308.") from error
    variables = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    return tree, tuple(sorted(variables))


def _open(dimension: Dimension) -> bool:
    """Whether a unit was left open or could not be read; such a unit fits every other one."""
    return bool(dimension.exponents[-1])


def _dimension(node: ast.expr, scope: _Scope, text: str) -> Dimension:
    match node:
        case ast.Constant(value=int() | float()) if not isinstance(node.value, bool):
            return _PLAIN
        case ast.Name(id=name):
            return _named(name, scope)
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=operand):
            return _dimension(operand, scope, text)
        case ast.BinOp(left=left, op=op, right=right):
            return _operation(left, op, right, scope, text)
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _FUNCTIONS:
            return _call(name, [_dimension(a, scope, text) for a in args], text)
        case ast.Call(func=ast.Name(id=name)):
            raise BadExpression(f"{name}() is not a function of expressions. {did_you_mean(name, _FUNCTIONS)}")
    raise BadExpression(f"={text}: {_RULE}")


def _named(name: str, scope: _Scope) -> Dimension:
    if name in scope:
        return parse_unit(scope[name][1]).dimension.without_angle
    if name in _CONSTANTS:
        return _PLAIN
    hint = did_you_mean(name, scope) if scope else "Declare it under parameters: first."
    raise BadExpression(f"there is no parameter {name} here. {hint}")


def _operation(left: ast.expr, op: ast.operator, right: ast.expr, scope: _Scope, text: str) -> Dimension:
    a, b = _dimension(left, scope, text), _dimension(right, scope, text)
    match op:
        case ast.Mult():
            return a * b
        case ast.Div():
            return a / b
        case ast.Add() | ast.Sub() if a == b or _open(a) or _open(b):
            return a
        case ast.Add() | ast.Sub():
            word = "adds" if isinstance(op, ast.Add) else "subtracts"
            pair = f"{a} and {b}" if word == "adds" else f"{b} from {a}"
            raise BadExpression(f"={text} {word} {pair}; both need one unit, and a bare number has none.")
        case ast.Pow() if a.plain and b.plain:
            return a
        case ast.Pow() if isinstance(right, ast.Constant) and isinstance(right.value, int | float):
            return a**right.value
        case ast.Pow():
            raise BadExpression(f"={text} raises {a} to a power; write that power as a number, such as height**2.")
    raise BadExpression(f"={text}: {_RULE}")


def _call(name: str, given: list[Dimension], text: str) -> Dimension:
    if name in ("min", "max"):
        if len(given) < 2 or any(d != given[0] for d in given):
            raise BadExpression(f"={text}: {name} compares two or more values; give it values of one unit.")
        return given[0]
    if len(given) != 1:
        raise BadExpression(f"={text}: {name} takes one value, and here it has {len(given)}; remove the others.")
    if name in ("abs", "sqrt"):
        return given[0] if name == "abs" else given[0] ** 0.5
    if not given[0].plain:
        rule = f"={text}: {name} takes a plain number or an angle, and this is {given[0]}"
        raise BadExpression(f"{rule}; divide it by another of its kind.")
    return _PLAIN
