"""The fixed sections of a spec, as pydantic models; the JSON Schema comes from the same place."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, WithJsonSchema
from pydantic_core import PydanticCustomError

from gaitsim.errors import Faults, Mark, did_you_mean
from gaitsim.spec.document import Mapping, Node, Sequence, plain
from gaitsim.spec.quantity import example, mismatch, needed
from gaitsim.units import UnknownUnit, known_units, parse_quantity, parse_unit


def _quantity(unit: str, above: float | None = None) -> tuple[BeforeValidator, WithJsonSchema]:
    """What makes a float one in SI, written with its unit."""

    def convert(value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise PydanticCustomError("quantity", "{text}", {"text": needed(unit).capitalize() + "."})
        try:
            quantity = parse_quantity(value)
        except UnknownUnit as error:
            text = f"'{error}' is no known unit. {did_you_mean(str(error), known_units())}"
            raise PydanticCustomError("quantity", "{text}", {"text": text}) from error
        if quantity is None:
            raise PydanticCustomError("quantity", "{text}", {"text": f'"{value}" is no number; {needed(unit)}.'})
        message = mismatch(quantity, parse_unit(unit))
        if not message and above is not None and not quantity.value > above:
            message = f'"{value}" is not above {above:g}; {needed(unit)}.'
        if message:
            raise PydanticCustomError("quantity", "{text}", {"text": message})
        return quantity.value

    schema = {"type": ["string", "number"], "examples": [example(unit)], "description": f"In {unit}."}
    return BeforeValidator(convert), WithJsonSchema(schema)


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


_Seconds = Annotated[float, *_quantity("s", above=0)]
_Acceleration = Annotated[float, *_quantity("m/s^2")]


class SimulateSection(_Section):
    """How long, in which steps, under which gravity."""

    duration: _Seconds = Field(description="Simulated time.")
    step: _Seconds = Field(description="Length of one step.")
    gravity: _Acceleration = Field(
        default=9.81, description="Gravitational acceleration, downwards. Geyer et al. 2003."
    )
    integrator: Literal["euler", "implicitfast"] = Field(
        default="euler",
        description="MuJoCo's semi-implicit Euler, or the same with implicit velocity forces. "
        "RK4 is not offered: split steps turn it into Euler without a word.",
    )


class Header(_Section):
    """A spec, as far as its shape is fixed; parts are checked against their components."""

    gaitsim: Literal[1] = Field(description="Version of this grammar.")
    about: str = Field(default="", description="What the model is, and its source.")
    extends: str = Field(default="", description="A spec to start from; path relative to this file.")
    use_for: dict[str, str] = Field(default={}, description="A component for every part of a kind.")
    parameters: dict[str, Any] = Field(default={}, description="Numbers used in several places as =name.")
    parts: dict[str, Any] = Field(description="The model's parts, by name.")
    initial: dict[str, Any] = Field(default={}, description="Initial coordinates and states, by address.")
    measures: dict[str, Any] = Field(default={}, description="What is measured in the loop, by name.")
    objective: dict[str, Any] = Field(default={}, description="The component that turns metrics into a cost.")
    simulate: SimulateSection = Field(description="Duration and step.")
    study: list[dict[str, Any]] = Field(default=[], description="Overrides, one run each: a table.")


def header(document: Mapping, faults: Faults) -> Header | None:
    """The header of a document; None after faults."""
    try:
        data = {key: value for key, value in plain(document).items() if value is not None}
        return Header.model_validate(data)
    except ValidationError as error:
        for detail in error.errors(include_url=False):
            _report(detail, document, faults)
        return None


def _report(detail: Any, document: Mapping, faults: Faults) -> None:
    path = [word for word in detail["loc"] if word != "[key]"]
    address = ".".join(str(word) for word in path)
    mark = _mark(document, path)
    match detail["type"]:
        case "extra_forbidden":
            section, word = path[:-1], str(path[-1])
            model = SimulateSection if section == ["simulate"] else Header
            where = ".".join(map(str, section)) or "a spec"
            message = f"{word} is no key of {where}. {did_you_mean(word, model.model_fields)}"
            faults.add(message, mark)
        case "missing":
            field = (SimulateSection if len(path) == 2 else Header).model_fields[str(path[-1])]
            sample = {"gaitsim": "gaitsim: 1", "parts": "parts: and below it the parts"}
            sample |= {"simulate": "simulate: {duration: 10 s, step: 1 ms}"}
            sample |= {"duration": "duration: 10 s", "step": "step: 1 ms"}
            message = f"is missing ({(field.description or '').rstrip('.').lower()}); write {sample[str(path[-1])]}."
            faults.add(message, mark, address)
        case "quantity":
            faults.add(detail["msg"], mark, address)
        case "literal_error" if path == ["gaitsim"]:
            faults.add(f'"{detail["input"]}" is no version of this grammar; write gaitsim: 1.', mark, address)
        case "literal_error":
            choices = detail["ctx"]["expected"].replace("'", "")
            extra = " (RK4 would silently become Euler here)" if str(detail["input"]).lower() == "rk4" else ""
            faults.add(f'"{detail["input"]}" is not offered{extra}; choose {choices}.', mark, address)
        case kind:
            wanted = {
                "dict_type": "a mapping of names",
                "string_type": "a text",
                "list_type": "a list of overrides",
            }
            faults.add(f"this needs {wanted.get(kind, detail['msg'])}.", mark, address)


def _mark(document: Mapping, path: list[Any]) -> Mark:
    """The place of the deepest word of a path that the document has."""
    node: Node = document
    mark = document.mark
    for word in path:
        if isinstance(node, Mapping) and word in node.entries:
            known_key, node = node.keys[word], node.entries[word]
            mark = known_key if isinstance(node, Mapping | Sequence) else node.mark
        elif isinstance(node, Sequence) and isinstance(word, int) and word < len(node.items):
            node = node.items[word]
            mark = node.mark
        else:
            return mark
    return mark
