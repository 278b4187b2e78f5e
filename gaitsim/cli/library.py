"""gaitsim library: what components there are, and what each declares."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, open_library

app = typer.Typer(help="List and show the components that specs can use.", no_args_is_help=True, rich_markup_mode=None)


@app.command("list")
def list_components(
    kind: Annotated[str, typer.Argument(metavar="[KIND]", help="One kind only, such as muscle.")] = "*",
    library: Libraries = None,
    json: Json = False,
) -> None:
    """List the components of the library, with one sentence each.

    Example: gaitsim library list muscle
    """
    from gaitsim.errors import Usage, did_you_mean
    from gaitsim.parts.describe import described

    parts = open_library(None, library)
    references = parts.references(kind)
    if not references:
        kinds = {reference.split("/")[0] for reference in parts.references()}
        raise Usage(f"there is no kind {kind}. {did_you_mean(kind, kinds)}")
    found = [described(parts.find(reference)) for reference in references]
    if json:
        console.give_json({"components": found})
    else:
        console.give_table(["component", "what it is"], [(c["use"], c["doc"].split("\n")[0]) for c in found])


@app.command("show")
def show_component(
    reference: Annotated[str, typer.Argument(metavar="KIND/NAME", help="Such as muscle/geyer2003.")],
    library: Libraries = None,
    json: Json = False,
) -> None:
    """Show what a component declares: parameters, ports, states, with units and sources.

    Example: gaitsim library show muscle/geyer2003
    """
    from gaitsim.parts.describe import described

    found = described(open_library(None, library).find(reference))
    if json:
        console.give_json(found)
        return
    console.give(f"{found['use']}  ({found['file']}, {found['digest'][:12]})\n\n{found['doc']}")
    for section, rows in found.items():
        if isinstance(rows, dict) and rows:
            console.give("")
            columns = list(dict.fromkeys(key for row in rows.values() for key in row))
            table = [(name, *(_cell(row.get(key)) for key in columns)) for name, row in rows.items()]
            console.give_table([section, *columns], table)


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, list | tuple):
        return ", ".join(_cell(item) for item in value)
    return f"{value:g}" if isinstance(value, float | int) and not isinstance(value, bool) else str(value)
