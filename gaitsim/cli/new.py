"""gaitsim new: a folder to begin with, from a spec that is shipped."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import Annotated

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json
from gaitsim.errors import command


def _shipped(incomplete: str) -> list[str]:
    from gaitsim.components.find import shipped_specs

    return [name for name in shipped_specs() if name.startswith(incomplete)]


def new(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Folder to create, such as demo.")],
    origin: Annotated[
        str, typer.Option("--from", metavar="NAME", help="Shipped spec to start from.", autocompletion=_shipped)
    ] = "hopping_leg_mass",
    json: Json = False,
) -> None:
    """Create a folder with a model that runs, a component of your own, its test and next steps.

    Examples:

    gaitsim new demo

    gaitsim new reflexes --from hopping_geyer2003
    """
    from gaitsim.errors import Usage
    from gaitsim.study.new_files import write_new
    from gaitsim.study.template import study

    if folder.exists():
        raise Usage(f"{folder} is there already; gaitsim new makes a folder of its own, so choose another name.")
    files = study(origin)
    write_new({folder / name: text for name, text in files.items()}, "name another folder")
    if json:
        console.give_json({"folder": str(folder), "files": list(files)})
        return
    for name in files:
        console.give(str(folder / name))
    first = f"cd {quote(str(folder))} && {command('run', f'my_{origin}.yaml')}"
    console.say(f"next: {first}; more in {folder / 'README.md'}")
