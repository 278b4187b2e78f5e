"""The sections of a spec, from the JSON schema that `gaitsim schema` prints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from parts_of_text import Page, code, escaped, number, table

from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.spec.json_schema import spec_schema

_HEAD = """\
# Sections of a spec

This page is generated from the JSON schema of specs. `gaitsim schema` prints the whole schema, with every component,
for completion in an editor. [Writing a spec](spec.md) explains the notation.
"""


def page() -> Page:
    """The sections of a spec and the fields of those whose shape is fixed."""
    schema = spec_schema(Library((shipped_folder(),)))
    required = {name for choice in schema["anyOf"][:1] for name in choice["required"]}
    texts = [_HEAD, _fields(schema["properties"], required)]
    for name, field in schema["properties"].items():
        reference = field.get("$ref", "").removeprefix("#/$defs/")
        if reference.endswith("Section"):
            inner = schema["$defs"][reference]
            texts += [f"## {name}\n\n{escaped(inner.get('description', ''))}\n", _fields(inner["properties"], set())]
    return Page("reference/spec-sections.md", "\n".join(texts))


def _fields(fields: Mapping[str, Any], required: set[str]) -> str:
    rows = [
        [code(name), _default(field, name in required), _choices(field) + escaped(field.get("description", ""))]
        for name, field in fields.items()
    ]
    return table(["key", "default", "meaning"], rows)


def _default(field: Mapping[str, Any], required: bool) -> str:
    if required:
        return "required"
    value = field.get("default")
    return "" if value in (None, "", [], {}) or isinstance(value, Mapping) else number(value)


def _choices(field: Mapping[str, Any]) -> str:
    words = field.get("enum", [])
    return ", ".join(code(str(word)) for word in words) + ". " if words else ""
