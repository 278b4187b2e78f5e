"""From a spec file to a Model: read, inherit, override, check, expand, connect."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from gaitsim.component import Parameter
from gaitsim.errors import Faults, did_you_mean
from gaitsim.model import WORLD, Model, Objective, Simulate, metric_units
from gaitsim.parts.composite import declared_parameters
from gaitsim.parts.find import Library
from gaitsim.spec.connect import Wiring
from gaitsim.spec.document import Mapping, Node
from gaitsim.spec.expand import Expansion
from gaitsim.spec.inheritance import override, with_parents
from gaitsim.spec.numbers import NumberTable
from gaitsim.spec.schema import Header, header
from gaitsim.spec.scope import Scope

Settings = Iterable[tuple[str, str]]


def read_spec(path: Path, settings: Settings = ()) -> Mapping:
    """The spec's document with its parents merged in and `--set` applied.

    Errors: InvalidSpec.
    """
    document = with_parents(path, str(path))
    for address, text in settings:
        document = override(document, address, text)
    return document


def resolve(document: Mapping, library: Library, name: str) -> Model:
    """The model of a document.

    Errors: InvalidSpec with every fault found.
    """
    faults = Faults()
    head = header(document, faults)
    faults.raise_if_any()
    assert head is not None
    table = NumberTable(faults)
    expansion = Expansion(library, faults, _kinds(head, document, library, faults), table)
    scope = Scope("", "", document.mark.file, {})
    _mask(document, table, scope, faults)
    _check_names(document, faults)
    for name_of in ("parts", "measures"):
        expansion.section(_section(document, name_of), scope, measure=name_of == "measures")
    expansion.finish()
    wiring = Wiring(expansion)
    connections = wiring.connections()
    parts = tuple(wiring.completed(part) for part in expansion.parts)
    initial = _initial(_section(document, "initial"), wiring, scope)
    objective = _objective(document, expansion, metric_units(parts, connections), scope)
    faults.raise_if_any()
    return Model(
        name=name,
        numbers=tuple(table.numbers),
        free=table.free(),
        parts=parts,
        groups=tuple(expansion.groups),
        connections=connections,
        initial=initial,
        objective=objective,
        simulate=Simulate(**head.simulate.model_dump()),
        notices=tuple(expansion.notices + library.notices),
    )


def _kinds(head: Header, document: Mapping, library: Library, faults: Faults) -> dict[str, str]:
    """`use_for`: kinds that are swapped as a whole."""
    section = _section(document, "use_for")
    for kind, reference in head.use_for.items():
        mark = section.entries[kind].mark
        if not library.references(kind):
            kinds = {known.split("/")[0] for known in library.references()}
            faults.add(f"there is no kind {kind}. {did_you_mean(kind, kinds)}", section.keys[kind], "use_for")
        elif reference not in library.references():
            hint = did_you_mean(reference, library.references(kind))
            faults.add(f"there is no component {reference}. {hint}", mark, f"use_for.{kind}")
    return head.use_for


def _mask(document: Mapping, table: NumberTable, scope: Scope, faults: Faults) -> None:
    """The spec's own parameters."""
    declared, defaults = declared_parameters(_section(document, "parameters"), faults)
    for name, parameter in declared.items():
        if name not in defaults:
            faults.add("needs a default:, such as {unit: kg, default: 80 kg}.", document.mark, name)
        index = table.add(name, name, defaults.get(name), parameter, dict(scope.names))
        scope.names[name] = (index, parameter.unit)


def _check_names(document: Mapping, faults: Faults) -> None:
    """One namespace: a name stands for one thing."""
    taken = {WORLD: "the ground", "initial": "a section", "simulate": "a section", "objective": "a section"}
    for section in ("parameters", "parts", "measures"):
        for name, mark in _section(document, section).keys.items():
            if name in taken:
                faults.add(f"{name} is already {taken[name]}; choose another name.", mark, name)
            taken[name] = f"in {section}"


def _initial(section: Mapping, wiring: Wiring, scope: Scope) -> dict[str, int]:
    """Initial coordinates and states: address of an output or a state -> number."""
    found = {}
    for key, node in section.entries.items():
        first, _, rest = key.partition(".")
        for name in scope.sided.get(first, (first,)):
            mark = section.keys[key]
            declared = wiring.initial(f"{name}.{rest}", mark)
            if declared is not None:
                address, unit = declared
                asked = Parameter(unit, f"the initial {address}")
                table = wiring.expansion.table
                found[address] = table.add(f"initial.{address}", f"initial.{key}", node, asked, scope.names)
    return found


def _objective(
    document: Mapping, expansion: Expansion, units: dict[str, str], scope: Scope
) -> Objective | None:
    """The objective, an expansion of its own whose inputs read metrics."""
    section = _section(document, "objective")
    if not section.entries:
        return None
    faults = expansion.faults
    alone = Expansion(expansion.library, faults, expansion.use_for, expansion.table)
    inner = Scope("", "", scope.file, scope.names, children={n: n for n in scope.children})
    entry = Mapping({"objective": section}, {"objective": document.keys["objective"]}, section.mark)
    alone.section(entry, inner)
    if len(alone.parts) != 1:
        if not faults.found:
            faults.add("an objective is one primitive component.", section.mark, "objective")
        return None
    (part,) = alone.parts
    metrics = {}
    for wire in alone.wires:
        if wire.source not in units:
            faults.add(f"{wire.source} is no metric. {did_you_mean(wire.source, units)}", wire.mark, wire.target)
        metrics[wire.target.removeprefix("objective.")] = wire.source
    wiring = Wiring(alone)
    part = wiring.completed(part)
    for name, declared in part.type.inputs.items():
        if name not in metrics and name not in part.constants and declared.default is None:
            rule = f"needs {name} ({declared.doc.rstrip('.')}); write {name}: {{from: a metric}}."
            faults.add(rule, part.mark, "objective")
    return Objective(part, metrics)


def _section(document: Mapping, name: str) -> Mapping:
    node: Node | None = document.entries.get(name)
    return node if isinstance(node, Mapping) else Mapping({}, {}, document.mark)
