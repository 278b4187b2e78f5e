"""The JSON Schema of specs: the fixed sections, and every component by its `use`."""

from __future__ import annotations

from typing import Any

from gaitsim.components.composite import ComponentFile, Composite
from gaitsim.components.find import Library
from gaitsim.errors import GaitsimError
from gaitsim.model import TERMS
from gaitsim.spec.schema import Header
from gaitsim.text.quantity import example

_CONNECTION = {
    "type": "object",
    "properties": {
        "from": {"type": "string", "description": "An output, such as soleus.force."},
        "delay": {"$ref": "#/$defs/value", "description": "Delay of the connection, such as 20 ms."},
        "initial": {"$ref": "#/$defs/value", "description": "The delayed signal before the start."},
    },
    "required": ["from"],
    "additionalProperties": False,
}
_QUANTITY = {"type": ["number", "string"]}
_VALUE = {
    "anyOf": [
        _QUANTITY,
        {
            "type": "object",
            "properties": {
                "value": _QUANTITY,
                "tune": {"type": "array", "items": _QUANTITY, "minItems": 2, "maxItems": 2},
                "spread": _QUANTITY,
                "source": {"type": "string"},
            },
            "additionalProperties": False,
        },
    ]
}
_WHOLE = {
    "anyOf": [
        {"type": ["integer", "string"]},
        {
            "type": "object",
            "properties": {"value": {"type": ["integer", "string"]}, "source": {"type": "string"}},
            "additionalProperties": False,
        },
    ]
}
_STRUCTURE = {
    "sides": {"type": "array", "items": {"enum": ["l", "r"]}, "description": "One part for each side."},
    "to": {"description": "Where outputs are summed: part.input, a list, or {output: part.input}."},
}


def spec_schema(library: Library) -> dict[str, Any]:
    """Make the schema of specs that use a library.

    Args:
        library: The components; those that cannot be loaded are left out.

    Returns:
        The schema as plain data.
    """
    schema = Header.model_json_schema()
    definitions = schema.setdefault("$defs", {})
    definitions |= {"value": _VALUE, "whole": _WHOLE, "connection": _CONNECTION}
    definitions["wired"] = {"anyOf": [{"$ref": "#/$defs/connection"}, {"$ref": "#/$defs/value"}]}
    cases = []
    for reference in library.references():
        try:
            definitions[reference] = _entry(library.find(reference))
        except GaitsimError:
            continue
        same = {"type": "object", "properties": {"use": {"const": reference}}, "required": ["use"]}
        cases.append({"if": same, "then": {"$ref": f"#/$defs/{reference.replace('/', '~1')}"}})
    known = sorted(name for name in definitions if "/" in name)
    entry = {"type": ["object", "null"], "properties": {"use": {"enum": known}}, "allOf": cases}
    definitions["part"] = entry
    for section in ("parts", "measures"):
        schema["properties"][section]["additionalProperties"] = {"$ref": "#/$defs/part"}
    about = schema["properties"]["objective"]["description"]
    schema["properties"]["objective"] = {"$ref": "#/$defs/part", "description": about}
    # Required keys may be in the parent of a spec.
    own = {"required": schema.pop("required")}
    own["properties"] = {"simulate": {"required": definitions["SimulateSection"].pop("required")}}
    schema["anyOf"] = [own, {"required": ["gaitsim", "extends"]}]
    schema["properties"]["initial"]["additionalProperties"] = {"$ref": "#/$defs/value"}
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "gaitsim spec"}


def _entry(component: ComponentFile) -> dict[str, Any]:
    """The schema of an entry that uses a component."""
    properties: dict[str, Any] = {"use": {"type": "string"}, **_STRUCTURE}
    for name, parameter in component.parameters.items():
        what = "whole" if parameter.whole else "wired"
        properties[name] = _described(what, parameter.doc, parameter.unit, parameter.source)
    for name in component.attachments:
        place = (
            "A frame, such as thigh.distal, or a place beside one, such as {on: thigh.distal, at: [1 cm, 0 m, 0 m]}."
        )
        properties[name] = {"type": ["string", "object"], "description": place}
    for name, link in component.links.items() if not isinstance(component, Composite) else ():
        properties[name] = {"type": "string", "description": f"{link.doc} A part, such as ankle."}
    if isinstance(component, Composite):
        properties |= {name: {"description": "An input of the composite."} for name in component.inputs}
        properties |= {
            name: {"type": ["object", "null"], "description": "Overrides for this inner part."}
            for name in component.parts.entries
        }
    else:
        for name, port in component.inputs.items():
            properties[name] = {"$ref": "#/$defs/wired", "description": f"{port.doc} [{port.unit}]"}
        if TERMS in component.inputs and component.kind == "objective":
            named = {"type": "object", "additionalProperties": {"$ref": "#/$defs/part"}}
            properties[TERMS] = named | {"description": component.inputs[TERMS].doc}
        for name, series in component.series.items():
            properties[name] = {"type": ["string", "array"], "description": f"{series.doc} [{series.unit}]"}
        properties |= {name: {"enum": list(o.choices), "description": o.doc} for name, o in component.options.items()}
        properties |= {name: {"type": "array", "description": p.doc} for name, p in component.points.items()}
        properties |= {name: {"$ref": "#/$defs/part", "description": p.doc} for name, p in component.parts.items()}
    return {
        "type": "object",
        "description": component.doc,
        "properties": properties,
        "additionalProperties": False,
    }


def _described(reference: str, doc: str, unit: str, source: str) -> dict[str, Any]:
    text = f"{doc} [{unit}]" + (f" ({source})" if source else "")
    return {"$ref": f"#/$defs/{reference}", "description": text, "examples": [example(unit)]}
