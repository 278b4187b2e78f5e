"""Tuned values beside a spec: walk.tuned.yaml, written by `optimize --adopt`."""

from __future__ import annotations

from collections.abc import Iterable
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from gaitsim.errors import Fault, InvalidSpec, Mark
from gaitsim.model import Free, Model
from gaitsim.optimization.problem import Problem, Variable
from gaitsim.text.document import MappingNode, Node, ScalarNode, dump, read
from gaitsim.text.quantity import mismatch
from gaitsim.units import Quantity, Unit, UnknownUnit, parse_quantity
from gaitsim.whole import write_whole

_ABOUT = "Written by gaitsim optimize --adopt; not by hand."
_FORMAT = 2  # without a format, numbers are in SI whatever unit they have
_ANEW = "write the file again with optimize --adopt."


@dataclass(frozen=True)
class TunedValues:
    """The content of a file of tuned values: the result that they come from, and the values in SI."""

    result: str
    values: dict[str, float]


def tuned_path(spec: Path) -> Path:
    """The path of the tuned values of a spec."""
    return spec.with_name(f"{spec.stem}.tuned.yaml")


def write_tuned(spec: Path, result: str, score: float, values: Mapping[str, float], units: Mapping[str, Unit]) -> Path:
    """Write the tuned values of a spec as text that reads back bit for bit.

    Args:
        spec: The spec.
        result: The name of the result.
        score: The score of the values.
        values: Values in SI by address.
        units: The units in which they are written.

    Returns:
        The path of the file.

    Raises:
        OSError: The file cannot be written.
    """
    path = tuned_path(spec)
    write_whole(path, tuned_text(result, score, values, units))
    return path


def tuned_text(result: str, score: float | None, values: Mapping[str, float], units: Mapping[str, Unit]) -> str:
    """The text of a file of tuned values.

    Args:
        result: The name of the result.
        score: The score; None if it is unknown.
        values: Values in SI by address.
        units: The units in which they are written.
    """
    texts = {a: v if units[a].text == "1" else units[a].exactly(v) for a, v in values.items()}
    known = {} if score is None else {"score": score}
    return dump({"about": _ABOUT, "format": _FORMAT, "result": result, **known, "values": texts})


def read_tuned(path: Path, free: Iterable[Free]) -> TunedValues:
    """Read a file of tuned values.

    Args:
        path: The file.
        free: The tuned numbers of the model, whose units must fit.

    Raises:
        InvalidSpec: The file has a fault.
    """
    document = read(path)
    values, result = document.entries.get("values"), document.entries.get("result")
    if not isinstance(values, MappingNode) or not isinstance(result, ScalarNode):
        raise InvalidSpec(Fault("this holds no tuned values; write it again with optimize --adopt.", Mark(str(path))))
    stated = document.entries.get("format")
    if stated is not None and not (isinstance(stated, ScalarNode) and stated.value == _FORMAT):
        rule = f"gaitsim reads tuned values of format {_FORMAT}, and this is another"
        raise InvalidSpec(Fault(f"{rule}; {_ANEW}", stated.mark, "format"))
    units = {each.address: each.unit for each in free}
    found = {}
    for address, node in values.entries.items():
        quantity = _quantity(node, in_si=stated is None)
        wrong = mismatch(quantity, units[address]) if address in units and stated is not None else ""
        if wrong:
            raise InvalidSpec(Fault(wrong, node.mark, address))
        found[address] = quantity.value
    return TunedValues(str(result.value), found)


def _quantity(node: Node, in_si: bool) -> Quantity:
    """Read one tuned value.

    Args:
        node: The value.
        in_si: Whether its number is in SI whatever its unit, as in old files.

    Raises:
        InvalidSpec: It is not a quantity.
    """
    if isinstance(node, ScalarNode) and isinstance(node.value, str | int | float) and not isinstance(node.value, bool):
        text = str(node.value).partition(" ")[0] if in_si else node.value
        try:
            quantity = parse_quantity(text)
        except UnknownUnit:
            quantity = None
        if quantity is not None:
            return quantity
    raise InvalidSpec(Fault(f"this is not a tuned value; {_ANEW}", node.mark))


def problem_of(model: Model, spread: float = 1.0) -> Problem:
    """The tuned numbers of a model as a problem.

    Args:
        model: The model.
        spread: A factor on the spreads of the spec.
    """
    return Problem(tuple(Variable(f.address, f.unit, f.low, f.high, f.start, spread * f.spread) for f in model.free))
