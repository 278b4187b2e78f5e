"""A model as plain data, as `show` prints it and model.yaml in a result has it."""

from __future__ import annotations

import math
from typing import Any

from gaitsim.model import Model


def model_data(model: Model) -> dict[str, Any]:
    """Parts, parameters, connections, initial values and metrics of a model.

    A number with a unit beside it is in that unit; all others are in SI.
    """
    return {
        "name": model.name,
        "simulate": {
            "duration": model.simulate.duration,
            "step": model.simulate.step,
            "gravity": model.simulate.gravity,
            "integrator": model.simulate.integrator,
        },
        "parts": part_rows(model),
        "parameters": parameter_rows(model),
        "connections": connection_rows(model),
        "metrics": model.metrics,
    }


def part_rows(model: Model) -> list[dict[str, Any]]:
    """Every part, composites included. Inner parts follow their parent; siblings are in the order of the spec."""
    rows: list[dict[str, Any]] = []
    groups = list(model.groups)
    for i, part in enumerate(model.parts):
        while groups and groups[0].before <= i:
            group = groups.pop(0)
            rows.append({"address": group.address, "use": group.reference, "at": str(group.mark)})
        row: dict[str, Any] = {"address": part.address, "use": part.type.reference, "at": str(part.mark)}
        if part.attachments:
            row["fastened"] = dict(part.attachments)
        rows.append(row)
    for each in model.objective.all if model.objective else ():
        rows.append({"address": each.part.address, "use": each.part.type.reference})
    return rows


def parameter_rows(model: Model) -> list[dict[str, Any]]:
    """Every number: value, unit, bounds of the search, expression, source, place.

    Values are in `unit`. Bounds and spread are in `tune_unit`, which differs for a share of a length.
    """
    values = model.values()
    rows = []
    for number, value in zip(model.numbers, values, strict=True):
        row: dict[str, Any] = {"address": number.address, "value": number.unit.of(value) if math.isfinite(value) else None}
        row["unit"] = number.unit.text
        if number.free is not None:
            free = model.free[number.free]
            of = free.unit.of
            row |= {"tune": [of(free.low), of(free.high)], "tune_unit": free.unit.text}
            row |= {"spread": of(free.spread), "tuned_as": free.address}
        if number.expression is not None:
            row["expression"] = number.expression.text
        if number.source:
            row["source"] = number.source
        if number.mark is not None:
            row["at"] = str(number.mark)
        rows.append(row)
    return rows


def connection_rows(model: Model) -> list[dict[str, Any]]:
    """Every connection, also those of parts with their inner parts."""
    values = model.values()
    rows = []
    for connection in model.connections:
        row: dict[str, Any] = {"from": connection.sender, "to": connection.target}
        if connection.delay is not None:
            row["delay"] = values[connection.delay]
        row["by"] = connection.made_by or str(connection.mark)
        rows.append(row)
    for each in model.objective.all if model.objective else ():
        place = each.part
        rows += [
            {"from": metric, "to": f"{place.address}.{name}", "by": str(place.mark)}
            for name, metric in each.metrics.items()
        ]
    return rows
