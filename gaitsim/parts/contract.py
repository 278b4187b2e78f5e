"""The contract of a kind: ports that all of its components share, so that one can replace another."""

from __future__ import annotations

from pathlib import Path

from gaitsim.errors import Fault, Mark
from gaitsim.parts.composite import ComponentFile, Composite
from gaitsim.spec.document import Mapping, Node, plain, read

_SECTIONS = ("inputs", "outputs", "parameters", "metrics")


def kind_faults(component: ComponentFile, contract: Path, file: str) -> list[Fault]:
    """What a component lacks of its kind's common ports and parameters."""
    document = read(contract)
    faults = []
    for section in _SECTIONS:
        wanted = document.entries.get(section)
        if not isinstance(wanted, Mapping):
            continue
        offered = _offered(component, section)
        for name, node in wanted.entries.items():
            unit = _unit(node)
            has = offered.get(name)
            if has is None:
                what = section[:-1].replace("_", " ")
                faults.append(
                    Fault(f"a {component.kind} has the {what} {name} [{unit}]; declare it ({contract})", Mark(file))
                )
            elif has not in (unit, "*") and unit != "*":
                faults.append(
                    Fault(f"{name} is in {has}; every {component.kind} has it in {unit} ({contract})", Mark(file))
                )
    return faults


def _offered(component: ComponentFile, section: str) -> dict[str, str]:
    """Names and units; a composite's ports take their units from inside, so any unit fits."""
    if isinstance(component, Composite):
        if section == "parameters":
            return {name: p.unit for name, p in component.parameters.items()}
        return dict.fromkeys(getattr(component, section, {}), "*")
    return {name: declared.unit for name, declared in getattr(component, section).items()}


def _unit(node: Node) -> str:
    value = plain(node)
    return str(value.get("unit", "1") if isinstance(value, dict) else value)
