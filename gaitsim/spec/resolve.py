"""From a spec file to a Model: read, inherit, override, check, expand, connect."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

from gaitsim.component import Parameter
from gaitsim.components.composite import declared_parameters
from gaitsim.components.find import Library
from gaitsim.components.primitive import Primitive
from gaitsim.errors import Faults, did_you_mean, with_article
from gaitsim.model import WORLD, Model, Part, Simulate, metric_units
from gaitsim.spec.connect import Wiring
from gaitsim.spec.expand import Expansion, sides
from gaitsim.spec.inheritance import override, with_parents
from gaitsim.spec.known import known_values
from gaitsim.spec.numbers import NumberTable
from gaitsim.spec.objective import read_objective
from gaitsim.spec.schema import Header, header
from gaitsim.spec.scope import Scope
from gaitsim.text.document import MappingNode, Node, ScalarNode

Settings = Iterable[tuple[str, str]]


def read_spec(path: Path, settings: Settings = ()) -> MappingNode:
    """Read a spec, merge it with its parents, and apply settings.

    Args:
        path: The file.
        settings: Pairs of an address and a value as text, such as those of `--set`.

    Returns:
        The document.

    Raises:
        InvalidSpec: A file cannot be read, or a setting cannot be applied.
    """
    document = with_parents(path, str(path))
    for address, text in settings:
        document = override(document, address, text)
    return document


def resolve(document: MappingNode, library: Library, name: str) -> Model:
    """Make the model of a document.

    Args:
        document: The document, with parents and settings applied.
        library: The components.
        name: The name of the model.

    Raises:
        InvalidSpec: The document has faults; the error holds all of them.
    """
    faults = Faults()
    head, document = header(document, faults)
    _check_names(document)
    if not isinstance(document.entries.get("parts"), MappingNode):
        faults.raise_if_any()
    table = NumberTable(faults)
    expansion = Expansion(library, faults, _kinds(document, library, faults), table)
    scope = Scope("", "", document.mark.file, {})
    _mask(document, table, scope, faults)
    expansion.announce(_section(document, "measures"), scope)  # parts may send to them
    for name_of in ("parts", "measures"):
        expansion.section(_section(document, name_of), scope, measure=name_of == "measures")
    expansion.finish()
    wiring = Wiring(expansion)
    connections = wiring.connections()
    parts = tuple(wiring.completed(part) for part in expansion.parts)
    initial = _initial(_section(document, "initial"), wiring, scope)
    objective, section = None, _section(document, "objective")
    units = metric_units(parts, connections)
    if section.entries:
        objective = read_objective(section, document.keys["objective"], expansion, units, scope)
    faults.raise_if_any()
    table.check_computed()
    known = known_values(document.entries.get("reproduces"), units, faults)
    faults.raise_if_any()
    assert head is not None
    simulate = Simulate(**head.simulate.model_dump())
    return Model(
        name=name,
        numbers=tuple(table.numbers),
        free=table.free(),
        parts=parts,
        groups=tuple(expansion.groups),
        connections=connections,
        initial=initial,
        objective=objective,
        simulate=simulate,
        notices=(
            *expansion.notices,
            *library.notices,
            *_long_steps(parts, simulate.step),
            *_short_lists(parts, simulate.duration),
        ),
        reproduces=known,
        dropped=frozenset(expansion.dropped),
    )


def _long_steps(parts: Iterable[Part], step: float) -> list[str]:
    """A warning for each component that is not accurate at this step."""
    beyond: dict[Primitive, list[str]] = {}
    for part in parts:
        if step > part.type.largest_step * (1 + 1e-9):
            beyond.setdefault(part.type, []).append(part.address)
    return [
        f"warning: {kind.reference} ({_few(addresses)}) is accurate up to a step of {1e3 * kind.largest_step:g} ms, "
        f"and simulate.step is {1e3 * step:g} ms; see gaitsim library show {kind.reference}"
        for kind, addresses in beyond.items()
    ]


def _short_lists(parts: Iterable[Part], duration: float) -> list[str]:
    """A warning for each list of instants that ends before the run does."""
    found = []
    for part in parts:
        for name, declared in part.type.series.items():
            ends = max(v for v in part.series[name].values if not math.isnan(v))
            if declared.listed and declared.unit == "s" and ends < duration * (1 - 1e-9):
                rule = f"end at {ends:g} s and the run lasts {duration:g} s; the last value holds until then"
                found.append(f"warning: {part.address}.{name} {rule}")
    return found


def _few(names: list[str]) -> str:
    return ", ".join(names if len(names) < 4 else [*names[:2], f"{len(names) - 2} more"])


def _kinds(document: MappingNode, library: Library, faults: Faults) -> dict[str, MappingNode]:
    """The section `use_for`: the component of each kind that is replaced as a whole."""
    section, found = _section(document, "use_for"), {}
    for kind, node in section.entries.items():
        entry = node if isinstance(node, MappingNode) else MappingNode({"use": node}, {"use": node.mark}, node.mark)
        use = entry.entries.get("use")
        reference = use.value if isinstance(use, ScalarNode) else None
        if not isinstance(reference, str):
            sample = f"{kind}/..., or {{use: {kind}/..., ...}}"
            faults.add(f"this names no component; write {kind}: {sample}.", node.mark, f"use_for.{kind}")
        elif kind not in library.kinds():
            hint = did_you_mean(kind, library.kinds())
            faults.add(f"there is no kind {kind}. {hint}", section.keys[kind], "use_for")
        elif reference not in library.references():
            faults.add(library.unknown(reference), node.mark, f"use_for.{kind}")
        elif reference.split("/")[0] != kind:
            rule = f"{reference} is not {with_article(kind)}; choose {', '.join(library.references(kind))}."
            faults.add(rule, node.mark, f"use_for.{kind}")
        else:
            found[kind] = entry
    return found


def _mask(document: MappingNode, table: NumberTable, scope: Scope, faults: Faults) -> None:
    """Read the parameters of the spec."""
    section = _section(document, "parameters")
    declared, defaults = declared_parameters(section, faults)
    for name, parameter in declared.items():
        if name not in defaults:
            faults.add("needs a default, such as {unit: kg, default: 80 kg}.", section.keys[name], name)
        index = table.add(name, name, defaults.get(name), parameter, dict(scope.names), default=True)
        scope.names[name] = (index, parameter.unit)


def _check_names(document: MappingNode) -> None:
    """Check that each name is used once.

    Raises:
        InvalidSpec: A name is used twice. Other faults are not searched for then.
    """
    faults = Faults()
    taken = {WORLD: "the ground"} | dict.fromkeys(Header.model_fields, "a section of specs")
    for section in ("parameters", "parts", "measures"):
        inside = _section(document, section)
        # Within one section, leg_l overrides leg.
        marks = {f"{name}_{side}": inside.keys[name] for name, node in inside.entries.items() for side in sides(node)}
        for name, mark in (marks | inside.keys).items():
            if name in taken:
                faults.add(f"{name} is already {taken[name]}; choose another name.", mark, name)
        taken |= dict.fromkeys(marks | inside.keys, f"one of the {section}")
    faults.raise_if_any()


def _initial(section: MappingNode, wiring: Wiring, scope: Scope) -> dict[str, int]:
    """The initial coordinates and states: the number for each address of an output or a state."""
    found = {}
    for key, node in section.entries.items():
        first, _, rest = key.partition(".")
        for name in scope.sided.get(first, (first,)):
            mark = section.keys[key]
            declared = wiring.initial(f"{name}.{rest}" if rest else name, mark)
            if declared is not None:
                address, unit = declared
                asked = Parameter(unit, f"the initial {address}")
                table = wiring.expansion.table
                found[address] = table.add(f"initial.{address}", f"initial.{key}", node, asked, scope.names)
    return found


def _section(document: MappingNode, name: str) -> MappingNode:
    node: Node | None = document.entries.get(name)
    return node if isinstance(node, MappingNode) else MappingNode({}, {}, document.mark)
