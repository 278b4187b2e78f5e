"""Recorded curves in a spec: `curve: norms/fukuchi2018_walking.knee_flexion`, or a list of numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from gaitsim.component import Series
from gaitsim.components.find import Library, faults_at
from gaitsim.components.table import resampled
from gaitsim.errors import Faults, GaitsimError
from gaitsim.model import Recording
from gaitsim.text.document import Node, ScalarNode, SequenceNode
from gaitsim.text.quantity import comma_within, example, measured, number, written_unit
from gaitsim.units import parse_unit

SAMPLE = "norms/fukuchi2018_walking.knee_flexion"


def read_series(
    name: str, declared: Series, node: Node, library: Library, faults: Faults, address: str
) -> Recording | None:
    """Read a recorded curve.

    Args:
        name: The name of the series.
        declared: Its declaration.
        node: The column or the list.
        library: The tables.
        faults: Receives the faults.
        address: The address of the series.

    Returns:
        `declared.size` numbers in SI at equal distances; None after a fault.
    """
    if isinstance(node, SequenceNode):
        before = len(faults.found)
        comma = comma_within(node)
        if comma:
            faults.add(f"one item has a unit and the one before it has none.{comma}", node.mark, address)
            return None
        given_in = written_unit(node) if declared.unit == "*" else None
        unit = given_in.text if given_in else declared.unit
        values = [number(item, unit, faults, f"{address}.{i}") for i, item in enumerate(node.items)]
        given = [v for v in values if v is not None]
        if declared.listed:
            _check_list(name, declared, node, given, faults, address)
        elif len(values) < 2:
            faults.add("a curve has two numbers or more, at equal distances.", node.mark, address)
        if len(faults.found) > before:
            return None
        if declared.listed:
            return Recording((*given, *[math.nan] * (declared.size - len(given))), unit=unit)
        return Recording(resampled(np.linspace(0, 1, len(given)), np.array(given), declared.size), unit=unit)
    text = node.value if isinstance(node, ScalarNode) else None
    if declared.listed:
        faults.add(f"{name} is a list; write such as {listed_sample(declared)}.", node.mark, address)
        return None
    if not isinstance(text, str) or "/" not in text:
        one = example("1" if declared.unit == "*" else declared.unit)
        rule = f"{name} is a recorded curve; write a column of a table, such as {SAMPLE}"
        faults.add(f"{rule}, or a list such as [{one}, {one}].", node.mark, address)
        return None
    reference, _, column = text.partition(".")
    try:
        table = library.table(reference)
    except GaitsimError as error:
        for fault in faults_at(node.mark, address, error):
            faults.add(fault.message, fault.mark, fault.address)
        return None
    if column not in table.columns:
        problem = f"{reference} has no column {column}" if column else f"{text} names no column"
        faults.add(f"{problem}; choose {', '.join(f'{reference}.{c}' for c in table.columns)}.", node.mark, address)
        return None
    given_unit = table.units[column]
    if declared.unit != "*" and parse_unit(given_unit).dimension != parse_unit(declared.unit).dimension:
        given_text = f"{text} is {measured(parse_unit(given_unit))} [{given_unit}]"
        rule = f"{name} takes {measured(parse_unit(declared.unit))} [{declared.unit}]; choose another column."
        faults.add(f"{given_text} but {rule}", node.mark, address)
        return None
    return Recording(table.curve(column, declared.size), text, table.recorded_by, given_unit)


def listed_sample(declared: Series) -> str:
    """A list that fits a series of numbers as they are written."""
    one = example("1" if declared.unit == "*" else declared.unit)
    return "[0 s, 10 s]" if _of_instants(declared) else f"[{one}, {one}]"


def _of_instants(declared: Series) -> bool:
    return parse_unit(declared.unit).dimension == parse_unit("s").dimension


def _check_list(
    name: str, declared: Series, node: SequenceNode, given: Sequence[float], faults: Faults, address: str
) -> None:
    """Check the length of a list, and that instants increase."""
    if not 2 <= len(node.items) <= declared.size:
        count = "is one number" if len(node.items) == 1 else f"are {len(node.items)} numbers"
        faults.add(f"{name} {count}; write 2 to {declared.size}.", node.mark, address)
    if not _of_instants(declared):
        return
    for before, now, item in zip(given, given[1:], node.items[1:], strict=False):
        if now <= before:
            rule = f"{now:g} s does not come after {before:g} s; put the instants in increasing order."
            faults.add(rule, item.mark, address)
