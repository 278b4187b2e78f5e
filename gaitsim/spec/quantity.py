"""Nodes that hold quantities: "22 kN" where a force is declared becomes 22000.0."""

from __future__ import annotations

import math
import re

from gaitsim.errors import Faults, nearest
from gaitsim.spec.document import Mapping, Node, Scalar
from gaitsim.units import Quantity, Unit, UnknownUnit, known_units, parse_quantity, parse_unit

_EXAMPLES = {
    "1": "0.5",
    "kg": "80 kg",
    "N": "2500 N",
    "m": "45 cm",
    "s": "20 ms",
    "rad": "30 deg",
    "rad/s": "90 deg/s",
    "m/s": "1.3 m/s",
    "N m": "10 N m",
    "m/s^2": "9.81 m/s^2",
}


def example(unit: str) -> str:
    """A quantity of this unit as one would write it."""
    return _EXAMPLES.get(unit, f"1 {unit}")


def measured(unit: Unit) -> str:
    """What a unit measures, in words; one without a word for it speaks for itself."""
    nameless = unit.article == f"a quantity of {unit.dimension.formula}"
    return f"a value in {unit.text}" if nameless else unit.article


def needed(unit: str) -> str:
    """What a declaration in this unit asks for, with an example."""
    return f'this needs {measured(parse_unit(unit))}, such as "{example(unit)}"'


def unknown_unit(text: str) -> str:
    """What is wrong with a text that is no unit."""
    wrong = next((word for word in re.findall(r"[A-Za-z%]+", text) if not _is_unit(word)), "")
    if not wrong:
        return f'"{text}" is no unit; write one such as N m/rad or kg m^2.'
    for i in range(1, len(wrong)):
        first, second = wrong[:i], wrong[i:]
        if {first, second} <= set(known_units()):
            return f'"{wrong}" is no known unit. Did you mean "{first} {second}"?'
    near = nearest(wrong, known_units())
    hint = f"Did you mean {near}?" if near else f"Known are {', '.join(known_units())}."
    return f'"{wrong}" is no known unit. {hint}'


def _is_unit(text: str) -> bool:
    try:
        parse_unit(text)
    except UnknownUnit:
        return False
    return True


def number(node: Node, unit: str, faults: Faults, address: str) -> float | None:
    """The SI value of a scalar node where `unit` is declared; None after a fault."""
    if not isinstance(node, Scalar) or isinstance(node.value, bool) or node.value is None:
        faults.add(f"{said(node)} is no number; {needed(unit)}.", node.mark, address)
        return None
    try:
        quantity = parse_quantity(node.value)
    except UnknownUnit as error:
        faults.add(unknown_unit(str(error)), node.mark, address)
        return None
    if quantity is None:
        faults.add(f'"{node.value}" is no number; {needed(unit)}.', node.mark, address)
        return None
    message = mismatch(quantity, parse_unit(unit))
    if message:
        faults.add(message, node.mark, address)
        return None
    return quantity.value


def number_with_unit(node: Node, unit: str, faults: Faults, address: str) -> float | None:
    """As `number`, but in the declared unit instead of SI."""
    value = number(node, unit, faults, address)
    return None if value is None else parse_unit(unit).of(value)


def mismatch(quantity: Quantity, declared: Unit) -> str:
    """What is wrong with a quantity; empty if it is finite and its unit fits."""
    given = quantity.unit
    if not math.isfinite(quantity.value):
        return "this number is too large; write one below 1.8e308."
    if given.dimension == declared.dimension or declared.text == "*":
        return ""
    if given.text == "1":
        unit = declared.text
        return f'{quantity.value:g} has no unit; {needed(unit)} (write "{quantity.value:g} {unit}").'
    if declared.dimension.plain and given.dimension == parse_unit("rad").dimension:
        return f"{given.text} is a unit of angle; {needed(declared.text)} (in radians: {quantity.value:.4g})."
    if given.dimension.plain:
        return f"{given.text} makes a plain number; {needed(declared.text)}."
    named = measured(given) == given.article
    words = f"a unit of {given.article.removeprefix('a ').removeprefix('an ')}" if named else "another unit"
    return f"{given.text} is {words}; {needed(declared.text)}."


def said(node: Node) -> str:
    """A node as an error names it."""
    if isinstance(node, Scalar):
        shown = {None: "nothing", True: "true", False: "false"}
        return shown.get(node.value, f'"{node.value}"')  # type: ignore[arg-type]
    return "a mapping" if isinstance(node, Mapping) else "a list"
