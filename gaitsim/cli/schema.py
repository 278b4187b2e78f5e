"""gaitsim schema: the JSON Schema of specs, for editors."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries
from gaitsim.study.opening import open_library


def schema(
    spec: Annotated[
        Path | None, typer.Argument(metavar="[SPEC]", help="Include the components beside this spec.")
    ] = None,
    library: Libraries = None,
    json: Json = True,  # noqa: ARG001 (a schema is JSON anyway)
) -> None:
    """Print the JSON Schema of specs, with all components.

    Example: gaitsim schema > gaitsim.schema.json
    """
    from gaitsim.spec.json_schema import spec_schema

    console.give_json(spec_schema(open_library(spec, library or ())))
