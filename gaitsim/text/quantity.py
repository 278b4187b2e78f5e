"""Quantities in nodes: "22 kN" becomes 22000.0 where a force is declared."""

from __future__ import annotations

import itertools
import math
import re
from unicodedata import decimal

from gaitsim.errors import Faults, nearest
from gaitsim.text.document import MappingNode, Node, ScalarNode, SequenceNode
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
# Letters in quantities, and what they are replaced by.
_PLAIN = {
    "[\N{MINUS SIGN}\N{EN DASH}]": "-",
    r"(?<=\d)\s*[\N{MIDDLE DOT}\N{DOT OPERATOR}\N{MULTIPLICATION SIGN}x*]\s*10\^([-+]?\d+)": r"e\1",
    r"(?<=\d)\s*\N{DEGREE SIGN}": " deg",
    "[\N{MICRO SIGN}\N{GREEK SMALL LETTER MU}]": "u",
    r"\s*[\N{MIDDLE DOT}\N{DOT OPERATOR}\N{MULTIPLICATION SIGN}\N{BULLET}]\s*": " ",
    "\N{SUPERSCRIPT TWO}": "^2",
    "\N{SUPERSCRIPT THREE}": "^3",
    r"\s+": " ",
}
_THOUSANDS = re.compile(r"\b\d{1,3}(,\d{3})+(?!\d)")


def example(unit: str) -> str:
    """An example of a quantity in a unit, for messages."""
    return _EXAMPLES.get(unit, f"1 {unit}")


def measured(unit: Unit) -> str:
    """The quantity that a unit measures, with its article; the unit itself if the quantity has no name."""
    nameless = unit.noun_phrase == f"a quantity of {unit.dimension.formula}"
    return f"a value in {unit.text}" if nameless else unit.noun_phrase


def needed(unit: str) -> str:
    """What a declaration with this unit needs, with an example."""
    return f'this needs {measured(parse_unit(unit))}, such as "{example(unit)}"'


class BadQuantity(ValueError):
    """A text is not a quantity of the unit that is needed; the message says why and what to write."""


def quantity_of(text: str | float, unit: str) -> Quantity:
    """Read a quantity where a unit is declared.

    Args:
        text: The quantity, or a plain number.
        unit: The declared unit.

    Raises:
        BadQuantity: The text is not a number, or its unit does not fit.
    """
    try:
        quantity = parse_quantity(text)
    except UnknownUnit as error:
        raise BadQuantity(in_plain_letters(text) or unknown_unit(str(error))) from error
    if quantity is None:
        raise BadQuantity(in_plain_letters(text) or f'"{text}" is not a number; {needed(unit)}.')
    wrong = mismatch(quantity, parse_unit(unit))
    if wrong:
        raise BadQuantity(wrong)
    return quantity


def in_plain_letters(text: str | float) -> str:
    """The correction of a quantity with letters that specs do not have, such as 2,5 kg or 170°; empty if there is
    none.
    """
    written = "".join(str(decimal(letter)) if letter.isdecimal() else letter for letter in str(text))
    for letters, plain in _PLAIN.items():
        written = re.sub(letters, plain, written)
    whole = _THOUSANDS.sub(lambda number: number[0].replace(",", ""), written)
    choices = [choice for choice in dict.fromkeys((written.replace(",", "."), whole)) if _is_quantity(choice)]
    if not choices or choices == [text]:
        return ""
    rule = "numbers have a point, no comma" if "," in written else "a spec has plain letters"
    if "\N{MINUS SIGN}" in str(text) or "\N{EN DASH}" in str(text):
        rule = "a minus is the hyphen of the keyboard"
    return f'"{text}" is not a quantity here: {rule}; write {" or ".join(_quoted(choice) for choice in choices)}.'


def _quoted(text: str) -> str:
    return f'"{text}"'


def _is_quantity(text: str) -> bool:
    try:
        return parse_quantity(text) is not None
    except UnknownUnit:
        return False


def unknown_unit(text: str) -> str:
    """The message for a text that is not a unit."""
    wrong = next((word for word in re.findall(r"[A-Za-z%]+", text) if not _is_unit(word)), "")
    if not wrong:
        return f'"{text}" is not a unit; write one such as N m/rad or kg m^2.'
    for i in range(1, len(wrong)):
        first, second = wrong[:i], wrong[i:]
        if {first, second} <= set(known_units()):
            return f'"{wrong}" is not a known unit. Did you mean "{first} {second}"?'
    near = nearest(wrong, known_units())
    hint = f"Did you mean {near}?" if near else f"Known are {', '.join(known_units())}."
    return f'"{wrong}" is not a known unit. {hint}'


def _is_unit(text: str) -> bool:
    try:
        parse_unit(text)
    except UnknownUnit:
        return False
    return True


def comma_within(node: SequenceNode) -> str:
    """The hint for a decimal comma that split a number into two items of a list, such as [1,5 kg]; empty if there is
    none.
    """
    items = node.items
    for first, second in itertools.pairwise(items):
        if isinstance(first, ScalarNode) and isinstance(second, ScalarNode) and type(first.value) is int:
            ending = str(second.value)
            alone = len(items) == 2 and type(second.value) is int
            if ending[:1].isdigit() and (alone or _has_unit(ending)) and _is_quantity(f"{first.value}.{ending}"):
                wrong, meant = f"{first.value},{ending}", f"{first.value}.{ending}"
                return f' A comma separates items; if "{wrong}" is one number, write {meant}.'
    return ""


def _has_unit(text: str) -> bool:
    try:
        quantity = parse_quantity(text)
    except UnknownUnit:
        return False
    return quantity is not None and quantity.unit.text != "1"


def number(node: Node, unit: str, faults: Faults, address: str) -> float | None:
    """The value in SI of a scalar node.

    Args:
        node: The node.
        unit: The declared unit.
        faults: Receives a fault if the node is not such a number.
        address: The address that the fault belongs to.

    Returns:
        The value; None after a fault.
    """
    if not isinstance(node, ScalarNode) or isinstance(node.value, bool) or node.value is None:
        hint = comma_within(node) if isinstance(node, SequenceNode) else ""
        faults.add(f"{quoted(node)} is not a number; {needed(unit)}.{hint}", node.mark, address)
        return None
    try:
        return quantity_of(node.value, unit).value
    except BadQuantity as error:
        faults.add(str(error), node.mark, address)
        return None


def written_unit(node: Node | None) -> Unit | None:
    """The unit in which a scalar, or the first item of a list, is written; None if it is not a quantity."""
    first = node.items[0] if isinstance(node, SequenceNode) and node.items else node
    if not isinstance(first, ScalarNode) or isinstance(first.value, bool) or first.value is None:
        return None
    try:
        quantity = parse_quantity(first.value)
    except UnknownUnit:
        return None
    return quantity.unit if quantity else None


def number_with_unit(node: Node, unit: str, faults: Faults, address: str) -> float | None:
    """The value of a scalar node in the declared unit; otherwise like `number`.

    Args:
        node: The node.
        unit: The declared unit.
        faults: Receives a fault if the node is not such a number.
        address: The address that the fault belongs to.
    """
    value = number(node, unit, faults, address)
    return None if value is None else parse_unit(unit).of(value)


def mismatch(quantity: Quantity, declared: Unit) -> str:
    """The message for a quantity that does not fit a declaration.

    Args:
        quantity: The quantity.
        declared: The declared unit.

    Returns:
        The message; empty if the quantity is finite and its unit fits.
    """
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
    named = measured(given) == given.noun_phrase
    meaning = f"a unit of {given.noun_phrase.removeprefix('a ').removeprefix('an ')}" if named else "another unit"
    return f"{given.text} is {meaning}; {needed(declared.text)}."


def quoted(node: Node) -> str:
    """A node as messages show it."""
    if isinstance(node, ScalarNode):
        shown = {None: "nothing", True: "true", False: "false"}
        return shown.get(node.value, f'"{node.value}"')  # type: ignore[arg-type]
    return "a mapping" if isinstance(node, MappingNode) else "a list"
