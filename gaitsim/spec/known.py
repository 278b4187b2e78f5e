"""The section `reproduces` of a spec: known values from elsewhere, and the metrics to compare with them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from gaitsim.errors import Faults, did_you_mean
from gaitsim.model import KnownValue
from gaitsim.text.document import MappingNode, Node, ScalarNode, SequenceNode
from gaitsim.text.quantity import number, written_unit


def known_values(section: Node | None, units: Mapping[str, str], faults: Faults) -> tuple[KnownValue, ...]:
    """Read the rows of the section.

    Args:
        section: The section, if there is one.
        units: The unit of every metric.
        faults: Receives a fault for each wrong row; such rows are left out.
    """
    rows = enumerate(section.items) if isinstance(section, SequenceNode) else ()
    return tuple(value for i, row in rows if isinstance(row, MappingNode) for value in _known(row, i, units, faults))


def _known(row: MappingNode, index: int, units: Mapping[str, str], faults: Faults) -> Iterator[KnownValue]:
    address = f"reproduces.{index}"
    entries = row.entries
    what, metric, source = (_text(entries.get(key)) for key in ("what", "metric", "source"))
    if metric not in units:
        rule = f"{metric} is not a metric. {did_you_mean(metric, units)}"
        faults.add(rule, entries["metric"].mark, f"{address}.metric")
        return
    value = number(entries["value"], units[metric], faults, f"{address}.value")
    width = entries.get("tolerance")
    tolerance = None if width is None else number(width, units[metric], faults, f"{address}.tolerance")
    if tolerance is not None and width is not None and tolerance < 0:
        rule = "a tolerance is not below 0; write the largest acceptable deviation."
        faults.add(rule, width.mark, f"{address}.tolerance")
    if not source.strip():
        rule = 'names no source; write a key of a references.bib, or such as "definition: a closed form".'
        faults.add(rule, entries["source"].mark, f"{address}.source")
    if value is not None:
        unit = written_unit(entries["value"])
        yield KnownValue(what, metric, value, unit.text if unit else units[metric], tolerance, source, row.mark)


def _text(node: Node | None) -> str:
    return str(node.value) if isinstance(node, ScalarNode) else ""
