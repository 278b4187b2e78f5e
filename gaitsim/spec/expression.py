"""Expressions such as `=0.245 * height`: only the own mask's parameters, units checked."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
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


class BadExpression(ValueError):
    """What is wrong with an expression, in words."""


@dataclass(frozen=True)
class Expression:
    """A checked expression: its text, compiled, and the numbers it reads by name."""

    text: str
    code: CodeType
    names: tuple[tuple[str, int], ...]

    def value(self, numbers: list[float]) -> float:
        """The value for these numbers. Errors: ArithmeticError, ValueError."""
        scope: dict[str, Any] = {name: numbers[index] for name, index in self.names}
        return float(eval(self.code, {"__builtins__": {}, **_FUNCTIONS, **_CONSTANTS}, scope))


def parse_expression(text: str, unit: str, scope: Mapping[str, tuple[int, str]]) -> Expression:
    """Check `text` (without the `=`) against the names of a mask: name -> (number, unit).

    Errors: BadExpression.
    """
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except SyntaxError as error:
        raise BadExpression(f"={text} cannot be read ({error.msg}); write such as =0.5 * height") from error
    units = {name: parse_unit(u).dimension.without_angle for name, (_, u) in scope.items()}
    found = _dimension(tree.body, units, text)
    declared = parse_unit(unit).dimension
    if declared.without_angle != found and unit != "*":
        raise BadExpression(f"={text} gives {found}; this needs {declared}")
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)} & set(scope)
    names = tuple((name, scope[name][0]) for name in sorted(used))
    return Expression(f"={text}", compile(tree, "<expression>", "eval"), names)


def _dimension(node: ast.expr, units: Mapping[str, Dimension], text: str) -> Dimension:
    match node:
        case ast.Constant(value=int() | float()) if not isinstance(node.value, bool):
            return _PLAIN
        case ast.Name(id=name):
            return _named(name, units)
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=operand):
            return _dimension(operand, units, text)
        case ast.BinOp(left=left, op=op, right=right):
            return _operation(left, op, right, units, text)
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _FUNCTIONS:
            return _call(name, [_dimension(a, units, text) for a in args], text)
        case ast.Call(func=ast.Name(id=name)):
            raise BadExpression(f"{name}() is no function of expressions. {did_you_mean(name, _FUNCTIONS)}")
    raise BadExpression(f"={text}: an expression has numbers, names, + - * / ** and functions only")


def _named(name: str, units: Mapping[str, Dimension]) -> Dimension:
    if name in units:
        return units[name]
    if name in _CONSTANTS:
        return _PLAIN
    raise BadExpression(f"{name} is no parameter of this mask. {did_you_mean(name, units)}")


def _operation(
    left: ast.expr, op: ast.operator, right: ast.expr, units: Mapping[str, Dimension], text: str
) -> Dimension:
    a, b = _dimension(left, units, text), _dimension(right, units, text)
    match op:
        case ast.Mult():
            return a * b
        case ast.Div():
            return a / b
        case ast.Add() | ast.Sub() if a == b:
            return a
        case ast.Add() | ast.Sub():
            word = "adds" if isinstance(op, ast.Add) else "subtracts"
            pair = f"{a} and {b}" if word == "adds" else f"{b} from {a}"
            raise BadExpression(f"={text} {word} {pair}")
        case ast.Pow() if a.plain and b.plain:
            return a
        case ast.Pow() if isinstance(right, ast.Constant) and isinstance(right.value, int | float):
            return a**right.value
    raise BadExpression(f"={text}: an expression has numbers, names, + - * / ** and functions only")


def _call(name: str, given: list[Dimension], text: str) -> Dimension:
    if name in ("min", "max"):
        if len(given) < 2 or any(d != given[0] for d in given):
            raise BadExpression(f"={text}: {name} compares two or more quantities of one unit")
        return given[0]
    if len(given) != 1:
        raise BadExpression(f"={text}: {name} takes one value")
    if name in ("abs", "sqrt"):
        return given[0] if name == "abs" else given[0] ** 0.5
    if not given[0].plain:
        raise BadExpression(f"={text}: {name} needs a plain number or an angle, not {given[0]}")
    return _PLAIN
