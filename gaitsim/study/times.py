"""Times as options have them: 2 s, 300 ms."""

from __future__ import annotations

from gaitsim.errors import Usage
from gaitsim.text.quantity import in_plain_letters
from gaitsim.units import UnknownUnit, parse_quantity, parse_unit

_TIME = "write a time, such as '2 s' or '300 ms'."


def seconds_of(option: str, text: str | None) -> float | None:
    """Read a time such as '2 s', '300 ms' or 2.

    Args:
        option: The name of the option, for messages.
        text: The time; None for none.

    Returns:
        The time in s; None without a text.

    Raises:
        Usage: The request does not fit.
    """
    if text is None:
        return None
    try:
        quantity = parse_quantity(text)
    except UnknownUnit:
        quantity = None
    if quantity is None or (quantity.unit.text != "1" and quantity.unit.dimension != parse_unit("s").dimension):
        raise Usage(f"{option} {text}: {in_plain_letters(text) or _TIME}")
    return quantity.value
