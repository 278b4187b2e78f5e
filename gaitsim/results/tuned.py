"""Tuned values beside a spec: walk.tuned.yaml, written by `optimize --adopt`, never by hand."""

from __future__ import annotations

from collections.abc import Mapping as Map
from pathlib import Path

from gaitsim.errors import Fault, InvalidSpec, Mark
from gaitsim.model import Model
from gaitsim.optimization.problem import Problem, Variable
from gaitsim.spec.document import Mapping, Scalar, dump, read
from gaitsim.units import UnknownUnit, parse_quantity

_ABOUT = "Written by gaitsim optimize --adopt; not by hand. Values in SI."


def tuned_path(spec: Path) -> Path:
    """Where the tuned values of a spec lie."""
    return spec.with_name(f"{spec.stem}.tuned.yaml")


def write_tuned(spec: Path, result: str, score: float, values: Map[str, float], units: Map[str, str]) -> Path:
    """Write the tuned values of a spec; the path. Errors: OSError."""
    path = tuned_path(spec)
    said = {
        address: value if units[address] == "1" else f"{value!r} {units[address]}" for address, value in values.items()
    }
    text = dump({"about": _ABOUT, "result": result, "score": score, "values": said})
    draft = path.with_name(f"{path.name}.partial")
    draft.write_text(text, encoding="utf-8")
    draft.replace(path)
    return path


def read_tuned(path: Path) -> tuple[str, dict[str, float]]:
    """The result that tuned values come from, and the values in SI.

    Errors: InvalidSpec.
    """
    document = read(path)
    values, result = document.entries.get("values"), document.entries.get("result")
    if not isinstance(values, Mapping) or not isinstance(result, Scalar):
        raise InvalidSpec(Fault("this holds no tuned values; write it anew with optimize --adopt.", Mark(str(path))))
    return str(result.value), {address: _number(node, path) for address, node in values.entries.items()}


def _number(node: object, path: Path) -> float:
    if isinstance(node, Scalar) and isinstance(node.value, str | int | float) and not isinstance(node.value, bool):
        try:
            quantity = parse_quantity(node.value)
        except UnknownUnit:
            quantity = None
        if quantity is not None:
            return quantity.value
    mark = node.mark if isinstance(node, Scalar) else Mark(str(path))
    raise InvalidSpec(Fault("this is no tuned value; write the file anew with optimize --adopt.", mark))


def problem_of(model: Model, spread: float = 1.0) -> Problem:
    """The tuned numbers of a model as a problem; spread is a factor on the spreads that the spec gives."""
    return Problem(tuple(Variable(f.address, f.unit, f.low, f.high, f.start, spread * f.spread) for f in model.free))
