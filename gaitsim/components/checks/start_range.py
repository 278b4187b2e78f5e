"""Where signals are when a run starts: the ranges that a component declares of inputs, outputs and states."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache

from gaitsim.component import Declaration, End, Input, Output, Parameter, State
from gaitsim.text.expression import BadExpression, Expression, parse_expression
from gaitsim.units import parse_unit, scaled

Ranged = Input | Output | State
Units = tuple[tuple[str, str], ...]  # of parameters, by name


def units_of(known: Mapping[str, Declaration]) -> Units:
    """The parameters that ends may name, with their units."""
    return tuple((name, one.unit) for name, one in known.items() if isinstance(one, Parameter))


def end_in_si(end: End, unit: str, parameters: Units, values: Mapping[str, float]) -> float:
    """One end of a range in SI; `values` are those of parameters in SI.

    Raises:
        ArithmeticError: The expression has no value.
        ValueError: The expression has no value.
    """
    if not isinstance(end, str):
        return scaled(end, parse_unit(unit).factor)
    return _expression(end, unit, parameters).value([values.get(name, 0.0) for name, _ in parameters])


def range_faults(name: str, one: Ranged, known: Mapping[str, Declaration]) -> Iterator[str]:
    """What is wrong with the ranges of a signal, in words."""
    for field, ends in (("usual", one.usual), ("possible", one.possible)):
        if ends is None:
            continue
        if isinstance(one, State) and (one.size is not None or one.levels):
            yield f"{name}: a range is of one number; leave out {field}."
        low, high = ends
        if not isinstance(low, str) and not isinstance(high, str) and not low < high:
            yield f"{name}: {field} {ends} is no range; write the lower end first."
        for end in (end for end in ends if isinstance(end, str)):
            try:
                _expression(end, one.unit, units_of(known))
            except BadExpression as error:
                yield f"{name}: {field}: {error}"


@cache
def _expression(end: str, unit: str, parameters: Units) -> Expression:
    """Parse one end of a range that is an expression of parameters.

    Raises:
        BadExpression: The expression is not valid.
    """
    return parse_expression(end, unit, {name: (index, own) for index, (name, own) in enumerate(parameters)})
