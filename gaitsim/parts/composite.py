"""A composite file: other components assembled behind a mask."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from gaitsim.component import Parameter
from gaitsim.errors import Faults, did_you_mean
from gaitsim.parts.load import digest_of
from gaitsim.parts.primitive import Primitive
from gaitsim.spec.document import Mapping, Node, Scalar, Sequence, read
from gaitsim.spec.quantity import number_with_unit

_SECTIONS = ("about", "parameters", "attachments", "frames", "inputs", "outputs", "parts")
_FIELDS = ("unit", "default", "doc", "source", "bounds")


@dataclass(frozen=True, eq=False)
class Composite:
    """One YAML component file; ports and frames name what they stand for inside."""

    reference: str
    path: Path
    source: str
    digest: str
    doc: str
    parameters: dict[str, Parameter]
    defaults: dict[str, Node]
    attachments: dict[str, str]
    frames: dict[str, str]
    inputs: dict[str, tuple[str, ...]]
    outputs: dict[str, str]
    parts: Mapping
    document: Mapping

    @property
    def kind(self) -> str:
        return self.reference.split("/")[0]

    @property
    def words(self) -> list[str]:
        """What an entry of a spec may say to this part."""
        return [*self.parameters, *self.inputs, *self.attachments, *self.parts.entries]


ComponentFile = Primitive | Composite


def load_composite(reference: str, path: Path, shown: str) -> Composite:
    """Load a composite file.

    Errors: InvalidSpec with every fault of the file's own grammar.
    """
    faults = Faults()
    document = read(path, shown)
    for word, mark in document.keys.items():
        if word not in _SECTIONS:
            faults.add(f"{word} is no section of a composite. {did_you_mean(word, _SECTIONS)}", mark)
    sections = {name: _mapping(document, name, faults) for name in _SECTIONS if name != "about"}
    if not sections["parts"].entries:
        faults.add("a composite needs parts: with at least one entry", document.mark)
    parameters, defaults = declared_parameters(sections["parameters"], faults)
    about = document.entries.get("about")
    composite = Composite(
        reference,
        path,
        path.read_text(encoding="utf-8-sig"),
        digest_of(path.read_text(encoding="utf-8-sig")),
        str(about.value) if isinstance(about, Scalar) else "",
        parameters,
        defaults,
        {name: _text(node, faults) for name, node in sections["attachments"].entries.items()},
        {name: _text(node, faults) for name, node in sections["frames"].entries.items()},
        {name: _targets(node, faults) for name, node in sections["inputs"].entries.items()},
        {name: _text(node, faults) for name, node in sections["outputs"].entries.items()},
        sections["parts"],
        document,
    )
    faults.raise_if_any()
    return composite


def declared_parameters(section: Mapping, faults: Faults) -> tuple[dict[str, Parameter], dict[str, Node]]:
    """The parameters of a mask and the nodes of their defaults."""
    parameters, defaults = {}, {}
    for name, node in section.entries.items():
        if not isinstance(node, Mapping):
            faults.add('a parameter is a mapping, such as {unit: kg, default: 80 kg}', node.mark, name)
            continue
        for word, mark in node.keys.items():
            if word not in _FIELDS:
                faults.add(f"{word} is no field of a parameter. {did_you_mean(word, _FIELDS)}", mark, name)
        parameters[name] = Parameter(
            _word(node, "unit") or "1",
            _word(node, "doc"),
            bounds=_bounds(node, name, faults),
            source=_word(node, "source"),
        )
        if "default" in node.entries:
            defaults[name] = node.entries["default"]
    return parameters, defaults


def _bounds(node: Mapping, name: str, faults: Faults) -> tuple[float, float] | None:
    """Bounds in the parameter's unit."""
    bounds = node.entries.get("bounds")
    if bounds is None:
        return None
    if not isinstance(bounds, Sequence) or len(bounds.items) != 2:
        faults.add("bounds are two values, such as [0 kg, 200 kg]", bounds.mark, name)
        return None
    unit = _word(node, "unit") or "1"
    low, high = (number_with_unit(item, unit, faults, name) for item in bounds.items)
    return None if low is None or high is None else (low, high)


def _word(node: Mapping, key: str) -> str:
    value = node.entries.get(key)
    return str(value.value) if isinstance(value, Scalar) and value.value is not None else ""


def _mapping(document: Mapping, name: str, faults: Faults) -> Mapping:
    node = document.entries.get(name)
    if node is None or (isinstance(node, Scalar) and node.value is None):
        return Mapping({}, {}, document.mark)
    if not isinstance(node, Mapping):
        faults.add(f"{name} is a mapping of names", node.mark)
        return Mapping({}, {}, document.mark)
    return node


def _text(node: Node, faults: Faults) -> str:
    if isinstance(node, Scalar) and isinstance(node.value, str):
        return node.value
    faults.add("this needs a text such as thigh.proximal", node.mark)
    return ""


def _targets(node: Node, faults: Faults) -> tuple[str, ...]:
    items = node.items if isinstance(node, Sequence) else (node,)
    return tuple(_text(item, faults) for item in items)
