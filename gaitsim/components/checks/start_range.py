"""The usual and possible ranges of signals at the start of a run, as declared for inputs, outputs and states."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache

from gaitsim.component import Declaration, End, Input, Output, Parameter, State
from gaitsim.text.expression import BadExpression, Expression, parse_expression
from gaitsim.units import parse_unit, scaled

Ranged = Input | Output | State
Units = tuple[tuple[str, str], ...]  # of parameters, by name


def units_of(known: Mapping[str, Declaration]) -> Units:
    """The parameters that the ends of ranges may name, with their units."""
    return tuple((name, one.unit) for name, one in known.items() if isinstance(one, Parameter))


def end_in_si(end: End, unit: str, parameters: Units, values: Mapping[str, float]) -> float:
    """Compute one end of a range.

    Args:
        end: A number in the unit, or an expression.
        unit: The unit of the signal.
        parameters: The parameters that the expression may name, with their units.
        values: Parameters in SI by name.

    Returns:
        The end in SI.

    Raises:
        ArithmeticError: The expression has no value.
        ValueError: The expression has no value.
    """
    if not isinstance(end, str):
        return scaled(end, parse_unit(unit).factor)
    return _expression(end, unit, parameters).value([values.get(name, 0.0) for name, _ in parameters])


def range_faults(name: str, one: Ranged, known: Mapping[str, Declaration]) -> Iterator[str]:
    """The messages for wrong ranges of a signal."""
    for field, ends in (("usual", one.usual), ("possible", one.possible)):
        if ends is None:
            continue
        if isinstance(one, State) and (one.size is not None or one.levels):
            yield f"{name}: a range is of one number; leave out {field}."
        low, high = ends
        if not isinstance(low, str) and not isinstance(high, str) and not low < high:
            yield f"{name}: {field} {ends} is not a range; write the lower end first."
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
