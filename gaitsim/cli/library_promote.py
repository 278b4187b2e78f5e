"""gaitsim library promote: move a component of a project to a library."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gaitsim.cli import console
from gaitsim.cli.library_uses import ManyResults, Where, give_tested, scope_of, tested_data
from gaitsim.cli.options import Json, Libraries
from gaitsim.errors import ExitCode


def promote(
    reference: Annotated[str, typer.Argument(metavar="KIND/NAME", help="Component of a project.")],
    where: Where = None,
    origin: Annotated[
        Path | None, typer.Option("--from", metavar="FOLDER", help="Project, or folder of kinds (default: this one).")
    ] = None,
    target: Annotated[
        Path | None, typer.Option("--to", metavar="FOLDER", help="Library (default: that of the lab).")
    ] = None,
    test: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Test of its physics (default: tests/test_NAME.py in the project)."),
    ] = None,
    replace: Annotated[
        bool,
        typer.Option(
            "--replace", help="Replace an existing component, unless this changes a spec or result that uses it."
        ),
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="With --replace: replace it even then.")] = False,
    results: ManyResults = None,
    library: Libraries = None,
    json: Json = False,
) -> int:
    """Move a component of a project into a library, with its test.

    It needs docs, sources that are in a references.bib, bounds, and a test of its physics, which is run in a copy of
    the library. Where the library has a component of this name, all users of that are run with the new one first.

    Examples:

    gaitsim library promote controller/my_reflex

    gaitsim library promote muscle/mine --from projects/alice --to library
    """
    from gaitsim.study.promotion import Changes, asked, promoted

    request = asked(reference, origin, target, test, replace, force, scope_of(where, results, library))
    try:
        done = promoted(request, console.ConsoleListener(json))
    except Changes as error:
        console.say_error(error)
        if json:
            console.give_json({"use": reference, "status": "differs", "users": [tested_data(t) for t in error.users]})
        else:
            give_tested(reference, error.users)
        return ExitCode.FAILED
    if json:
        files = {"files": [str(path) for path in done.files], "removed": [str(path) for path in done.removed]}
        console.give_json({"use": reference, **files, "users": [tested_data(t) for t in done.users]})
        return 0
    for path in done.files:
        console.give(str(path))
    if done.users:
        give_tested(reference, done.users)
    if done.removed:
        console.say(f"moved from {request.origin}: {', '.join(str(path) for path in done.removed)}")
    else:
        console.say(f"{request.origin} keeps its copy, because its specs do not look into {request.target}")
    return 0
