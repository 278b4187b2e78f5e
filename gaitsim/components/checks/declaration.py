"""Checks of declarations: every field must have the right type."""

from __future__ import annotations

import ast
import dataclasses
import math
from collections.abc import Iterator, Mapping
from typing import Any

from gaitsim import component
from gaitsim.component import (
    Curve,
    Declaration,
    Input,
    Metric,
    Option,
    Output,
    Parameter,
    Points,
    Series,
    State,
    StepLimit,
)
from gaitsim.errors import did_you_mean
from gaitsim.units import UnknownUnit, known_units, parse_unit


def unit_rule(unit: str) -> str:
    """The message for a text that is not a unit."""
    return f'"{unit}" is not a unit; write one made of {", ".join(known_units())}, or "1".'


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and not math.isnan(value)


def _texts(value: Any) -> bool:
    return isinstance(value, tuple) and all(isinstance(item, str) for item in value)


def _is_optional_text_or_number(value: Any) -> bool:
    return value is None or isinstance(value, str) or _number(value)


def _numbers(value: Any) -> bool:
    return isinstance(value, tuple) and bool(value) and all(map(_number, value))


# For each field: a test of its value, and the words for what is allowed.
_FIELDS: dict[str, tuple[Any, str]] = {
    "unit": (lambda v: isinstance(v, str), 'a unit in quotes, such as "N m"'),
    "doc": (lambda v: isinstance(v, str), "a text in quotes"),
    "source": (lambda v: isinstance(v, str), "a text in quotes"),
    "kind": (lambda v: isinstance(v, str) and v.isidentifier(), 'a kind in quotes, such as "path"'),
    "default": (_is_optional_text_or_number, "a number, or a text in quotes"),
    "bounds": (
        lambda v: v is None or (isinstance(v, tuple) and len(v) == 2 and all(map(_number, v))),
        "two numbers in brackets, such as (0, 1)",
    ),
    "size": (lambda v: v is None or (type(v) is int and v > 0), "a whole number above 0"),
    "levels": (_texts, 'names in brackets, such as ("swing", "stance")'),
    "choices": (lambda v: _texts(v) and bool(v), 'words in brackets, such as ("first", "second")'),
    "value": (lambda v: _number(v) and v > 0, "a number above 0"),
    "like": (lambda v: isinstance(v, str), "the name of a series, in quotes"),
    "sums": (lambda v: isinstance(v, bool), "True or False"),
    "reads": (
        lambda v: isinstance(v, tuple) and all(_texts(pair) and len(pair) == 2 for pair in v),
        'pairs of names in brackets, such as (("length", "path_length"),)',
    ),
}
_FIELDS = {
    **_FIELDS,
    "of": (lambda v: isinstance(v, str), "an output or a function of this file, in quotes"),
    "over": (lambda v: isinstance(v, str), "a name in quotes"),
    "span": (lambda v: _numbers(v) and len(v) == 2 and all(map(math.isfinite, v)), "two numbers in brackets"),
    "at": (
        lambda v: isinstance(v, Mapping) and all(isinstance(x, str) or _number(x) for x in v.values()),
        'values by name, such as {"load": 0.5}',
    ),
    "each": (
        lambda v: v is None or (isinstance(v, tuple) and len(v) == 2 and isinstance(v[0], str) and _numbers(v[1])),
        'a name and its values, such as ("activation", (0.1, 1))',
    ),
    "steps": (
        lambda v: isinstance(v, Mapping) and all(map(_numbers, v.values())),
        'values one after the other, such as {"excitation": (0, 1, 0)}',
    ),
    "usual": (
        lambda v: (
            v is None or (isinstance(v, tuple) and len(v) == 2 and all(isinstance(x, str) or _number(x) for x in v))
        ),
        'two ends in brackets, such as (0, 1) or ("lower - 0.1", "upper + 0.1")',
    ),
    "over_unit": _FIELDS["unit"],
    "inverse": _FIELDS["sums"],
}
_FIELDS |= {"possible": _FIELDS["usual"]}
_FIELDS |= {"sends": _FIELDS["reads"], "gives": _FIELDS["reads"], "optional": _FIELDS["sums"]}
_FIELDS |= {"listed": _FIELDS["sums"], "whole": _FIELDS["sums"]}


def field_faults(name: str, one: Declaration) -> Iterator[str]:
    """The messages for wrong fields of one declaration."""
    for field in dataclasses.fields(one):
        fits, wanted = _FIELDS[field.name]
        value = getattr(one, field.name)
        if field.name == "default" and isinstance(one, Parameter | Input):
            fits, wanted = (lambda v: v is None or _number(v)), f"a number without unit, as it is in {one.unit}"
        if not fits(value):
            yield f"{name}: {field.name} is {value!r}; write {wanted}."
            return
    if isinstance(one, Parameter | Input | Output | State | Metric | Points | Series | StepLimit | Curve):
        try:
            unit = parse_unit(one.unit)
        except UnknownUnit:
            yield f"{name}: {unit_rule(one.unit)}"
        else:
            if isinstance(one, StepLimit) and unit.dimension != parse_unit("s").dimension:
                yield f'{name}: {one.unit} is not a unit of time; write such as StepLimit("ms", "...", 0.5).'
    if isinstance(one, Parameter) and one.whole and one.default is not None and one.default % 1:
        yield f"{name}: default {one.default} is not a whole number, and whole=True says so."
    if isinstance(one, Parameter) and one.bounds is not None:
        low, high = one.bounds
        if low > high:
            yield f"{name}: bounds ({low}, {high}) are reversed."
        elif one.default is not None and not low <= one.default <= high:
            yield f"{name}: default {one.default} is outside its bounds ({low}, {high})."
    if isinstance(one, Option) and one.default not in (None, *one.choices):
        hint = did_you_mean(str(one.default), one.choices)
        yield f"{name}: default {one.default} is not one of its choices. {hint}"


def like_faults(name: str, one: Metric | Input | Output, known: Mapping[str, Declaration]) -> Iterator[str]:
    """The messages for a port or a metric whose unit is said to be that of something else."""
    kind, like = type(one).__name__, known.get(one.like)
    if not isinstance(like, Series | Parameter if kind == "Output" else Series):
        also = " or a parameter" if kind == "Output" else ""
        yield f"{name}: like is {one.like!r}, which is not a series{also} of this file; write the name of one."
    if one.unit != "*":
        rule = f'has the unit of what it names; write {kind}("*", ...)'
        yield f"{name}: {'a' if kind == 'Metric' else 'an'} {kind.lower()} with like={one.like!r} {rule}."


def unknown_fields(tree: ast.Module) -> Iterator[tuple[str, ast.keyword]]:
    """Find fields that a declaration does not have, before the file is run.

    Yields:
        The message and the place of each fault.
    """
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in component.__all__):
            continue
        declared = getattr(component, node.func.id)
        if not dataclasses.is_dataclass(declared):
            continue
        known = [field.name for field in dataclasses.fields(declared)]
        for word in node.keywords:
            if word.arg is not None and word.arg not in known:
                yield f"{node.func.id} has no {word.arg}. {did_you_mean(word.arg, known)}", word
