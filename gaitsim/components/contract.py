"""The contract of a kind: ports and parameters that all of its components have, so that they are interchangeable."""

from __future__ import annotations

from functools import cache

from gaitsim.components.checks.check import declaration_marks, parse
from gaitsim.components.composite import ComponentFile, Composite
from gaitsim.errors import Fault, Faults, Mark
from gaitsim.text.document import MappingNode, Node, plain
from gaitsim.text.document import parse as parse_document
from gaitsim.text.quantity import quoted, unknown_unit
from gaitsim.text.spelling import respelled
from gaitsim.units import UnknownUnit, parse_unit

_SECTIONS = ("inputs", "outputs", "parameters", "metrics")


def kind_faults(component: ComponentFile, contract: str, file: str, named: str) -> list[Fault]:
    """Find the common ports and parameters of its kind that a component lacks.

    Args:
        component: The component.
        contract: The text of kind.yaml.
        file: The name of the component's file in messages.
        named: The name of kind.yaml in messages.

    Raises:
        InvalidSpec: The contract itself breaks a rule.
    """
    faults = []
    for section, units in read_contract(contract, named).items():
        offered = _offered(component, section)
        for name, unit in units.items():
            has = offered.get(name)
            if has is None:
                lack = f"this lacks the {section[:-1]} {name} [{unit}]"
                rule = f"{lack}, which every component of {component.kind}/ has ({named}); declare it."
                faults.append(Fault(rule, _mark(component, section, "", file)))
            elif has not in (unit, "*") and unit != "*":
                rule = f"{name} is in [{has}], and every component of {component.kind}/ has it in [{unit}] ({named})"
                faults.append(Fault(f"{rule}; declare it in [{unit}].", _mark(component, section, name, file)))
    return faults


@cache  # a kind has many components
def read_contract(text: str, named: str) -> dict[str, dict[str, str]]:
    """Read what a kind.yaml requires.

    Returns:
        Units by section and name.

    Raises:
        InvalidSpec: The file has a fault.
    """
    faults = Faults()
    document = respelled(parse_document(text, named), ("about", *_SECTIONS), "a kind has no section", faults)
    found: dict[str, dict[str, str]] = {}
    for section in _SECTIONS:
        wanted = document.entries.get(section, MappingNode({}, {}, document.mark))
        if not isinstance(wanted, MappingNode):
            faults.add(
                f"{quoted(wanted)} is not a mapping of names; write such as {section}: {{force: N}}.", wanted.mark
            )
            continue
        found[section] = {}
        for name, node in wanted.entries.items():
            found[section][name] = _unit(node)
            try:
                parse_unit(_unit(node))
            except UnknownUnit as error:
                faults.add(unknown_unit(str(error)), node.mark, name)
    faults.raise_if_any()
    return found


def _mark(component: ComponentFile, section: str, name: str, file: str) -> Mark:
    """The place where a component declares a name; the place of the component if it does not."""
    if isinstance(component, Composite):
        return component.mark(section, name)
    lines = component.text.splitlines()
    return declaration_marks(parse(component.text, file), file, lines)[name]


def _offered(component: ComponentFile, section: str) -> dict[str, str]:
    """Units by name. The ports of a composite have the units of inner ports, so every unit fits them."""
    if isinstance(component, Composite):
        if section == "parameters":
            return {name: p.unit for name, p in component.parameters.items()}
        return dict.fromkeys(getattr(component, section, {}), "*")
    return {name: declared.unit for name, declared in getattr(component, section).items()}


def _unit(node: Node) -> str:
    value = plain(node)
    return str(value.get("unit", "1") if isinstance(value, dict) else value)
