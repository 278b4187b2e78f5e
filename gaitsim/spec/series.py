"""Recorded curves in a spec: `curve: norms/fukuchi2018_walking.knee_flexion`, or a list of numbers."""

from __future__ import annotations

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
        if len(values) < 2:
            faults.add("a curve has two numbers or more, at equal distances.", node.mark, address)
        given = [v for v in values if v is not None]
        if len(faults.found) > before:
            return None
        return Recording(resampled(np.linspace(0, 1, len(given)), np.array(given), declared.size), unit=unit)
    text = node.value if isinstance(node, ScalarNode) else None
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
        said = f"{reference} has no column {column}" if column else f"{text} names no column"
        faults.add(f"{said}; choose {', '.join(f'{reference}.{c}' for c in table.columns)}.", node.mark, address)
        return None
    given_unit = table.units[column]
    if declared.unit != "*" and parse_unit(given_unit).dimension != parse_unit(declared.unit).dimension:
        words = f"{text} is {measured(parse_unit(given_unit))} [{given_unit}]"
        rule = f"{name} takes {measured(parse_unit(declared.unit))} [{declared.unit}]; choose another column."
        faults.add(f"{words} but {rule}", node.mark, address)
        return None
    return Recording(table.curve(column, declared.size), text, table.recorded_by, given_unit)
