"""gaitsim show: what a spec resolves to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, Results, Set, Spec, Trust, opening


def show(
    spec: Spec,
    tree: Annotated[
        bool, typer.Option("--tree", help="Parts, their components, and which library has each (the default).")
    ] = False,
    parameters: Annotated[bool, typer.Option("--parameters", help="Every number with its unit and source.")] = False,
    connections: Annotated[bool, typer.Option("--connections", help="Every connection between parts.")] = False,
    mjcf: Annotated[bool, typer.Option("--mjcf", help="The mechanics as MuJoCo XML.")] = False,
    start: Annotated[bool, typer.Option("--start", help="Ignore the tuned values beside the spec.")] = False,
    results: Results = None,
    trust: Trust = False,
    settings: Set = None,
    library: Libraries = None,
    json: Json = False,
) -> None:
    """Show the resolved model: parts, numbers, connections, mechanics.

    Example: gaitsim show specs/hopping_geyer2003.yaml --connections
    """
    from gaitsim.results.listing import connection_rows, parameter_rows, part_rows

    opened = opening(spec, settings, library, tuned=not start, trusted=trust, results=results).open()
    model = opened.model()
    data: dict[str, Any] = {}
    if tree or not (parameters or connections or mjcf):
        data["tree"] = [{**row, "library": opened.library.serves(row["use"])} for row in part_rows(model)]
    if parameters:
        data["parameters"] = parameter_rows(model)
    if connections:
        data["connections"] = connection_rows(model)
    if mjcf:
        from gaitsim.compiler.mjcf import assemble

        data["mjcf"] = assemble(model, model.values()).xml
    for notice in (*opened.notices, *model.notices):
        console.say(notice)
    if json:
        console.give_json(data)
        return
    for section, rows in data.items():
        _PRINTERS[section](rows)


def _tree(rows: list[dict[str, Any]]) -> None:
    wide = max((len(row["use"]) for row in rows), default=0)
    for row in rows:
        depth = row["address"].count(".")
        name = row["address"].rpartition(".")[2]
        fastened = ", ".join(f"{k}: {v}" for k, v in row.get("fastened", {}).items())
        line = f"{'  ' * depth}{name}"
        text = f"{line:<32} {row['use']:<{wide}}  {row['library']:<8}{'  (' + fastened + ')' if fastened else ''}"
        console.give(text.rstrip())


def _parameters(rows: list[dict[str, Any]]) -> None:
    table = []
    for row in rows:
        low, high = row.get("tune", (None, None))
        other = f" {row['tune_unit']}" if row.get("tune_unit", row["unit"]) != row["unit"] else ""
        bounds = "" if low is None else f"[{low:g}, {high:g}]{other}"
        origin = row.get("expression") or row.get("source", "")
        table.append((row["address"], console.formatted(row["value"]), row["unit"], bounds, origin))
    console.give_table(["parameter", "value", "unit", "tune", "from"], table)


def _connections(rows: list[dict[str, Any]]) -> None:
    table = [
        (row["from"], row["to"], f"{row['delay'] * 1000:g} ms" if "delay" in row else "", row["by"]) for row in rows
    ]
    console.give_table(["from", "to", "delay", "made by"], table)


_PRINTERS: dict[str, Callable[[Any], None]] = {
    "tree": _tree,
    "parameters": _parameters,
    "connections": _connections,
    "mjcf": console.give,
}
