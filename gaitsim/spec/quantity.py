"""Nodes that hold quantities: "22 kN" where a force is declared becomes 22000.0."""

from __future__ import annotations

from gaitsim.errors import Faults, did_you_mean
from gaitsim.spec.document import Node, Scalar
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


def needed(unit: str) -> str:
    """What a declaration in this unit asks for, with an example."""
    return f'this needs {parse_unit(unit).article}, such as "{example(unit)}"'


def number(node: Node, unit: str, faults: Faults, address: str) -> float | None:
    """The SI value of a scalar node where `unit` is declared; None after a fault."""
    if not isinstance(node, Scalar) or isinstance(node.value, bool) or node.value is None:
        faults.add(f"{said(node)} is no number; {needed(unit)}.", node.mark, address)
        return None
    try:
        quantity = parse_quantity(node.value)
    except UnknownUnit as error:
        hint = did_you_mean(str(error), known_units())
        faults.add(f"{str(error)!r} is no known unit. {hint}", node.mark, address)
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
    return None if value is None else value / parse_unit(unit).factor


def mismatch(quantity: Quantity, declared: Unit) -> str:
    """What is wrong with the unit of a quantity; empty if it fits."""
    given = quantity.unit
    if given.dimension == declared.dimension or declared.text == "*":
        return ""
    if given.text == "1":
        unit = declared.text
        return f'{quantity.value:g} has no unit; {needed(unit)} (write "{quantity.value:g} {unit}").'
    if declared.dimension.plain and given.dimension == parse_unit("rad").dimension:
        return f'{given.text} is a unit of angle; {needed(declared.text)} (in radians: {quantity.value:.4g}).'
    return f"{given.text} is a unit of {_noun(given)}; {needed(declared.text)}."


def _noun(unit: Unit) -> str:
    words = unit.article.split(" ", 1)
    return words[1] if words[0] in ("a", "an") else unit.article


def said(node: Node) -> str:
    """A node as an error names it."""
    if isinstance(node, Scalar):
        shown = {None: "nothing", True: "true", False: "false"}
        return shown.get(node.value, f'"{node.value}"')  # type: ignore[arg-type]
    return f"a {type(node).__name__.lower()}"
