"""The declarations of a component as plain data, for listings, reference pages and schemas."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from gaitsim.components.composite import ComponentFile, Composite
from gaitsim.components.find import display_path
from gaitsim.components.primitive import Primitive
from gaitsim.text.document import plain

_SECTIONS = (
    "parameters",
    "points",
    "series",
    "options",
    "attachments",
    "frames",
    "links",
    "inputs",
    "outputs",
    "states",
    "metrics",
    "parts",
    "step_limits",
    "curves",
)


def described(component: ComponentFile) -> dict[str, Any]:
    """Reference, file, digest, documentation and all declarations of a component, as plain data."""
    head = {
        "use": component.reference,
        "kind": component.kind,
        "file": display_path(component.path),
        "digest": component.digest,
        "doc": component.doc,
    }
    return head | (_composite(component) if isinstance(component, Composite) else _primitive(component))


def _primitive(component: Primitive) -> dict[str, Any]:
    return {
        section: {name: _declaration(d) for name, d in getattr(component, section).items()} for section in _SECTIONS
    }


def _composite(component: Composite) -> dict[str, Any]:
    return {
        "parameters": {name: _masked(component, name) for name in component.parameters},
        "attachments": {name: {"doc": doc} for name, doc in component.attachments.items()},
        "frames": {name: {"is": target} for name, target in component.frames.items()},
        "inputs": {name: {"is": list(targets)} for name, targets in component.inputs.items()},
        "outputs": {name: {"is": target} for name, target in component.outputs.items()},
        "parts": {name: {"use": _use(node)} for name, node in component.parts.entries.items()},
    }


def _masked(component: Composite, name: str) -> dict[str, Any]:
    """A parameter of a composite. Its default is as written: a quantity or an expression."""
    node = component.defaults.get(name)
    found = plain(node) if node is not None else None
    default, source = (found.get("value"), found.get("source", "")) if isinstance(found, dict) else (found, "")
    declared = _declaration(component.parameters[name])
    return declared | {"default": default, "source": declared["source"] or source}


def _use(node: Any) -> str:
    return str(node.entries["use"].value) if "use" in getattr(node, "entries", {}) else ""


def _declaration(declaration: Any) -> dict[str, Any]:
    return {field.name: getattr(declaration, field.name) for field in fields(declaration)}
