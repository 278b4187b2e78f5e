"""gaitsim new: a new folder from a shipped spec, or a project from a result or a spec."""

from __future__ import annotations

import os
from pathlib import Path
from shlex import quote
from typing import Annotated

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Results, Trust
from gaitsim.errors import command


def _shipped(incomplete: str) -> list[str]:
    from gaitsim.distribution import shipped_specs

    return [name for name in shipped_specs() if name.startswith(incomplete)]


def new(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", help="Folder to create, such as demo; or the word project.")
    ],
    name: Annotated[
        str | None, typer.Argument(metavar="[NAME]", help="Name of the project, after the word project.")
    ] = None,
    origin: Annotated[
        str,
        typer.Option(
            "--from",
            metavar="NAME",
            help="Shipped spec to start from; for a project also a result, or a spec of yours.",
            autocompletion=_shipped,
        ),
    ] = "hopping_leg_mass",
    trust: Trust = False,
    results: Results = None,
    json: Json = False,
) -> None:
    """Create a folder with a model that runs, or a project in a lab. A project starts from a result or a spec.

    Examples:

    gaitsim new demo

    gaitsim new reflexes --from hopping_geyer2003

    gaitsim new project alice --from results/2026-11-22-hopping-3f9c
    """
    from gaitsim.errors import Usage

    if name is not None:
        if str(folder) != "project":
            raise Usage(f"{name}: one folder is made at a time; write gaitsim new FOLDER, or gaitsim new project NAME.")
        _new_project(name, origin, trust, results, json)
        return
    _new_folder(folder, origin, json)


def _new_folder(folder: Path, origin: str, json: bool) -> None:
    from gaitsim.errors import Usage
    from gaitsim.study.new_files import write_new
    from gaitsim.study.template import study

    if folder.exists():
        raise Usage(f"{folder} exists already; gaitsim new makes a folder of its own, so choose another name.")
    files = study(origin)
    write_new({folder / name: text for name, text in files.items()}, "name another folder")
    if json:
        console.give_json({"folder": str(folder), "files": list(files)})
        return
    for name in files:
        console.give(str(folder / name))
    mine = f"my_{origin}.yaml"
    first = f"cd {quote(str(folder))} && {command('run', mine if mine in files else f'{origin}.yaml')}"
    console.say(f"next: {first}; more in {folder / 'README.md'}")


def _new_project(name: str, origin: str, trust: bool, results: Path | None, json: bool) -> None:
    from gaitsim.study.projects import new_project, project_data

    begun = new_project(name, origin, Path.cwd(), results, trust)
    files = [os.path.relpath(path) for path in begun.files]
    if json:
        console.give_json({**project_data(begun.project), "files": files, "copied": begun.copied})
        return
    for path in files:
        console.give(path)
    for path, why in begun.copied.items():
        console.say(f"{path} is a copy, because {why}")
    place = quote(os.path.relpath(begun.project.folder))
    console.say(f"next: cd {place} && {command('run', begun.project.spec.name)}; more in {place}/README.md")
