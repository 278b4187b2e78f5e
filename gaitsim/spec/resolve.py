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
from gaitsim.spec.document import Mapping, Node, Scalar
from gaitsim.spec.expand import Expansion, sides
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
    head, document = header(document, faults)
    _check_names(document)
    if not isinstance(document.entries.get("parts"), Mapping):
        faults.raise_if_any()
    table = NumberTable(faults)
    expansion = Expansion(library, faults, _kinds(document, library, faults), table)
    scope = Scope("", "", document.mark.file, {})
    _mask(document, table, scope, faults)
    for name_of in ("parts", "measures"):
        expansion.section(_section(document, name_of), scope, measure=name_of == "measures")
    expansion.finish()
    wiring = Wiring(expansion)
    connections = wiring.connections()
    parts = tuple(wiring.completed(part) for part in expansion.parts)
    initial = _initial(_section(document, "initial"), wiring, scope)
    objective = _objective(document, expansion, metric_units(parts, connections), scope)
    faults.raise_if_any()
    table.check_computed()
    faults.raise_if_any()
    assert head is not None
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
        dropped=frozenset(expansion.dropped),
    )


def _kinds(document: Mapping, library: Library, faults: Faults) -> dict[str, str]:
    """`use_for`: kinds that are swapped as a whole."""
    section, found = _section(document, "use_for"), {}
    for kind, node in section.entries.items():
        reference = node.value if isinstance(node, Scalar) else None
        if not isinstance(reference, str):
            continue  # the header has told of it
        if kind not in library.kinds():
            hint = did_you_mean(kind, library.kinds())
            faults.add(f"there is no kind {kind}. {hint}", section.keys[kind], "use_for")
        elif reference not in library.references():
            faults.add(library.unknown(reference), node.mark, f"use_for.{kind}")
        elif reference.split("/")[0] != kind:
            rule = f"{reference} is no {kind}; choose {', '.join(library.references(kind))}."
            faults.add(rule, node.mark, f"use_for.{kind}")
        else:
            found[kind] = reference
    return found


def _mask(document: Mapping, table: NumberTable, scope: Scope, faults: Faults) -> None:
    """The spec's own parameters."""
    section = _section(document, "parameters")
    declared, defaults = declared_parameters(section, faults)
    for name, parameter in declared.items():
        if name not in defaults:
            faults.add("needs a default, such as {unit: kg, default: 80 kg}.", section.keys[name], name)
        index = table.add(name, name, defaults.get(name), parameter, dict(scope.names))
        scope.names[name] = (index, parameter.unit)


def _check_names(document: Mapping) -> None:
    """One namespace: a name stands for one thing.

    Errors: InvalidSpec; what else is wrong cannot be told before names are clear.
    """
    faults = Faults()
    taken = {WORLD: "the ground"} | dict.fromkeys(Header.model_fields, "a section of specs")
    for section in ("parameters", "parts", "measures"):
        inside = _section(document, section)
        # Below each other, leg_l says what differs from leg.
        marks = {f"{name}_{side}": inside.keys[name] for name, node in inside.entries.items() for side in sides(node)}
        for name, mark in (marks | inside.keys).items():
            if name in taken:
                faults.add(f"{name} is already {taken[name]}; choose another name.", mark, name)
        taken |= dict.fromkeys(marks | inside.keys, f"one of the {section}")
    faults.raise_if_any()


def _initial(section: Mapping, wiring: Wiring, scope: Scope) -> dict[str, int]:
    """Initial coordinates and states: address of an output or a state -> number."""
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


def _objective(
    document: Mapping, expansion: Expansion, units: dict[str, str], scope: Scope
) -> Objective | None:
    """The objective, an expansion of its own whose inputs read metrics."""
    section = _section(document, "objective")
    if not section.entries:
        return None
    faults = expansion.faults
    alone = Expansion(expansion.library, faults, expansion.use_for, expansion.table, broken=expansion.broken)
    inner = Scope("", "", scope.file, scope.names, children={n: n for n in scope.children})
    entry = Mapping({"objective": section}, {"objective": document.keys["objective"]}, section.mark)
    alone.section(entry, inner)
    if not alone.parts:
        return None
    part = alone.parts[0]
    if len(alone.parts) > 1 or "cost" not in part.type.outputs:
        references = ", ".join(expansion.library.references("objective"))
        rule = f"an objective gives one output, cost; use one of {references}."
        faults.add(rule, section.entries["use"].mark, "objective")
        return None
    metrics = {}
    for wire in alone.wires:
        if wire.source not in units and not expansion.is_broken(wire.source):
            faults.add(f"{wire.source} is no metric. {did_you_mean(wire.source, units)}", wire.mark, wire.target)
        metrics[wire.target.removeprefix("objective.")] = wire.source
    wiring = Wiring(alone)
    part = wiring.completed(part)
    for name, declared in part.type.inputs.items():
        given = name in metrics or name in part.constants or f"objective.{name}" in alone.ports.tried
        if not given and declared.default is None:
            metric = next(iter(units), "metric")
            rule = f"needs {name} ({declared.doc.rstrip('.')}); write {name}: {{from: {metric}}}."
            faults.add(rule, part.mark, "objective")
    return Objective(part, metrics)


def _section(document: Mapping, name: str) -> Mapping:
    node: Node | None = document.entries.get(name)
    return node if isinstance(node, Mapping) else Mapping({}, {}, document.mark)
