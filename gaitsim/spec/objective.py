"""The objective of a spec: a part whose inputs read metrics, and its terms, which are objectives too."""

from __future__ import annotations

from collections.abc import Mapping

from gaitsim.errors import Mark, did_you_mean
from gaitsim.model import TERMS, Objective
from gaitsim.spec.connect import Wiring
from gaitsim.spec.expand import Expansion
from gaitsim.spec.inheritance import without
from gaitsim.spec.scope import Scope
from gaitsim.text.document import MappingNode, Node
from gaitsim.text.quantity import measured, quoted
from gaitsim.units import parse_unit


def read_objective(
    section: MappingNode,
    mark: Mark,
    expansion: Expansion,
    units: Mapping[str, str],
    scope: Scope,
    address: str = "objective",
) -> Objective | None:
    """Read an objective.

    Args:
        section: The section.
        mark: The place of its key.
        expansion: The parts of the spec; receives the faults.
        units: The unit of every metric.
        scope: The scope of names.
        address: The address of the objective.

    Returns:
        The objective; None after a fault.
    """
    faults = expansion.faults
    alone = Expansion(expansion.library, faults, expansion.use_for, expansion.table, broken=expansion.broken)
    above, _, name = address.rpartition(".")
    inner = Scope(above, above, scope.file, scope.names, children={n: n for n in scope.children})
    alone.single_entry(name, without(section, TERMS), mark, inner)
    if not alone.parts:
        return None
    part = alone.parts[0]
    if len(alone.parts) > 1 or "cost" not in part.type.outputs:
        references = ", ".join(expansion.library.references("objective"))
        rule = f"an objective gives one output, cost; use one of {references}."
        faults.add(rule, section.entries["use"].mark, address)
        return None
    metrics = _metrics(alone, address, units)
    part = Wiring(alone).completed(part)
    for name, declared in part.type.inputs.items():
        given = name in metrics or name in part.constants or f"{address}.{name}" in alone.ports.tried
        if not given and declared.default is None and not declared.sums:
            metric = next(iter(units), "metric")
            rule = f"needs {name} ({declared.doc.rstrip('.')}); write {name}: {{from: {metric}}}."
            faults.add(rule, part.mark, address)
    given_terms = section.entries.get(TERMS)
    if given_terms is None:
        return Objective(part, metrics)
    if not (TERMS in part.type.inputs and part.type.inputs[TERMS].sums):
        rule = f"{part.type.reference} has no terms; use objective/weighted_sum, which adds them."
        faults.add(rule, section.keys[TERMS], address)
        return None
    return Objective(part, metrics, _terms(given_terms, expansion, units, scope, f"{address}.{TERMS}"))


def _terms(
    node: Node, expansion: Expansion, units: Mapping[str, str], scope: Scope, address: str
) -> tuple[Objective, ...]:
    """The terms of an objective, whose costs are added."""
    if not isinstance(node, MappingNode):
        sample = "{effort: {use: objective/minimize, value: {from: effort}}}"
        expansion.faults.add(
            f"{quoted(node)} is not a mapping of names; write such as terms: {sample}.", node.mark, address
        )
        return ()
    found = []
    for name, term in node.entries.items():
        if not isinstance(term, MappingNode):
            rule = "a term is a mapping that begins with use:, such as {use: objective/minimize, ...}."
            expansion.faults.add(rule, node.keys[name], f"{address}.{name}")
            continue
        made = read_objective(term, node.keys[name], expansion, units, scope, f"{address}.{name}")
        if made is not None:
            found.append(made)
    return tuple(found)


def _metrics(alone: Expansion, address: str, units: Mapping[str, str]) -> dict[str, str]:
    """The metrics that the inputs read, with fitting units."""
    metrics = {}
    for wire in alone.wires:
        name = wire.target.removeprefix(f"{address}.")
        if wire.sender not in units:
            if not alone.is_broken(wire.sender):
                hint = did_you_mean(wire.sender, units)
                alone.faults.add(f"{wire.sender} is not a metric. {hint}", wire.mark, wire.target)
            continue
        given, asked = units[wire.sender], alone.parts[0].type.inputs[name].unit
        if "*" not in (given, asked) and parse_unit(given).dimension != parse_unit(asked).dimension:
            sent = f"{wire.sender} is {measured(parse_unit(given))} [{given}]"
            rule = f"{name} takes {measured(parse_unit(asked))} [{asked}]; choose another metric."
            alone.faults.add(f"{sent} but {rule}", wire.mark, wire.target)
        metrics[name] = wire.sender
    return metrics
