"""Composite files: several components that are used as one, with parameters, ports and frames of their own."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from gaitsim.component import Parameter
from gaitsim.components.load import as_lines, digest_of
from gaitsim.components.primitive import Primitive
from gaitsim.errors import Faults, Mark
from gaitsim.text.document import MappingNode, Node, ScalarNode, SequenceNode, parse
from gaitsim.text.quantity import number_with_unit, quoted, unknown_unit
from gaitsim.text.spelling import respelled
from gaitsim.units import UnknownUnit, parse_unit

_SECTIONS = ("about", "parameters", "attachments", "frames", "inputs", "outputs", "parts")
_SAMPLES = {
    "parameters": "{height: {unit: m, default: 1.8 m}}",
    "attachments": "{parent: What it hangs from.}",
    "frames": "{proximal: thigh.proximal}",
    "inputs": "{excitation: soleus.excitation}",
    "outputs": "{load: foot.load}",
    "parts": "{thigh: {use: segment/rod, ...}}",
}
_FIELDS = ("unit", "default", "doc", "source", "bounds")


@dataclass(frozen=True, eq=False)
class Composite:
    """One YAML component file. Its ports and frames name ports and frames of its inner parts."""

    reference: str
    path: Path
    text: str
    digest: str
    doc: str
    parameters: dict[str, Parameter]
    defaults: dict[str, Node]
    attachments: dict[str, str]
    frames: dict[str, str]
    inputs: dict[str, tuple[str, ...]]
    outputs: dict[str, str]
    parts: MappingNode
    document: MappingNode

    @property
    def kind(self) -> str:
        return self.reference.split("/")[0]

    @property
    def keys(self) -> list[str]:
        """The keys that an entry of a spec may have for this component."""
        return [*self.parameters, *self.inputs, *self.attachments, *self.parts.entries]

    def mark(self, section: str, name: str) -> Mark:
        """The place of a name in a section."""
        inside = self.document.entries.get(section)
        return inside.keys.get(name, inside.mark) if isinstance(inside, MappingNode) else self.document.mark


ComponentFile = Primitive | Composite


def load_composite(reference: str, path: Path, display_path: str, text: str) -> Composite:
    """Load a composite.

    Args:
        reference: Kind and name, such as "muscle_group/geyer2010".
        path: The file.
        display_path: The name of the file in messages.
        text: The text of the file.

    Raises:
        InvalidSpec: The file has faults; the error holds all of them.
    """
    faults = Faults()
    document = respelled(parse(text, display_path), _SECTIONS, "a composite has no section", faults)
    sections = {name: _mapping(document, name, faults) for name in _SECTIONS if name != "about"}
    if not sections["parts"].entries:
        faults.add("a composite has no parts; write parts: and below it at least one.", document.mark)
    _told_apart(sections, faults)
    parameters, defaults = declared_parameters(sections["parameters"], faults)
    about = document.entries.get("about")
    text = as_lines(text.removeprefix("\ufeff"))
    composite = Composite(
        reference,
        path,
        text,
        digest_of(text),
        str(about.value) if isinstance(about, ScalarNode) else "",
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


def _told_apart(sections: dict[str, MappingNode], faults: Faults) -> None:
    """A fault for each name that an entry of a spec could mean in two ways, such as a parameter and an input."""
    meanings: dict[str, str] = {}
    for section, what in (
        ("parameters", "a parameter"),
        ("inputs", "an input"),
        ("attachments", "an attachment"),
        ("parts", "a part"),
    ):
        for name, key in sections[section].keys.items():
            if name in meanings:
                faults.add(
                    f"{name} is {meanings[name]} and {what}; an entry of a spec means one; rename one of the two.", key
                )
            meanings.setdefault(name, what)


def declared_parameters(section: MappingNode, faults: Faults) -> tuple[dict[str, Parameter], dict[str, Node]]:
    """Read the section `parameters:`.

    Args:
        section: The section.
        faults: Receives the faults.

    Returns:
        The declarations, and the nodes of their defaults, by name.
    """
    parameters: dict[str, Parameter] = {}
    defaults: dict[str, Node] = {}
    for name, node in section.entries.items():
        if not isinstance(node, MappingNode):
            faults.add("this needs a unit and a default; write such as {unit: kg, default: 80 kg}.", node.mark, name)
            parameters[name], defaults[name] = Parameter("*", ""), ScalarNode(0, node.mark)
            continue
        node = respelled(node, _FIELDS, "a parameter has no key", faults, name)
        parameters[name] = Parameter(
            _unit(node, name, faults),
            _word(node, "doc"),
            bounds=_bounds(node, name, faults),
            source=_word(node, "source"),
        )
        if "default" in node.entries:
            defaults[name] = node.entries["default"]
    return parameters, defaults


def _unit(node: MappingNode, name: str, faults: Faults) -> str:
    """The unit of a parameter. After a fault it is left open, so that no other fault follows from it."""
    unit = _word(node, "unit") or "1"
    try:
        return parse_unit(unit).text
    except UnknownUnit:
        faults.add(unknown_unit(unit), node.entries["unit"].mark, name)
        return "*"


def _bounds(node: MappingNode, name: str, faults: Faults) -> tuple[float, float] | None:
    """Bounds in the parameter's unit."""
    bounds = node.entries.get("bounds")
    if bounds is None:
        return None
    if not isinstance(bounds, SequenceNode) or len(bounds.items) != 2:
        faults.add("bounds are two values; write such as bounds: [0 kg, 200 kg].", bounds.mark, name)
        return None
    unit = _unit(node, name, faults)
    low, high = (number_with_unit(item, unit, faults, name) for item in bounds.items)
    if low is None or high is None:
        return None
    if low > high:
        rule = f"the bounds {quoted(bounds.items[0])} and {quoted(bounds.items[1])} are reversed; exchange them."
        faults.add(rule, bounds.mark, name)
        return None
    return low, high


def _word(node: MappingNode, key: str) -> str:
    value = node.entries.get(key)
    return str(value.value) if isinstance(value, ScalarNode) and value.value is not None else ""


def _mapping(document: MappingNode, name: str, faults: Faults) -> MappingNode:
    node = document.entries.get(name)
    if node is None or (isinstance(node, ScalarNode) and node.value is None):
        return MappingNode({}, {}, document.mark)
    if not isinstance(node, MappingNode):
        faults.add(
            f"{quoted(node)} is not a mapping of names; write such as {name}: {_SAMPLES[name]}.", node.mark, name
        )
        return MappingNode({}, {}, document.mark)
    return node


def _text(node: Node, faults: Faults) -> str:
    if isinstance(node, ScalarNode) and isinstance(node.value, str):
        return node.value
    faults.add(f"{quoted(node)} is not a name; write such as thigh.proximal.", node.mark)
    return ""


def _targets(node: Node, faults: Faults) -> tuple[str, ...]:
    items = node.items if isinstance(node, SequenceNode) else (node,)
    return tuple(_text(item, faults) for item in items)
