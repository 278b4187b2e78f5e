"""gaitsim library used-by, test and history: the users of a component, and the effect of a change on them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gaitsim.cli import console
from gaitsim.cli.archive import DIFFERENCE_COLUMNS, difference_data, difference_rows
from gaitsim.cli.options import Json, Libraries, Reference, Trust
from gaitsim.errors import ExitCode
from gaitsim.folders import results_folder

if TYPE_CHECKING:
    from gaitsim.study.acceptance import Effect
    from gaitsim.study.uses import Scope

Where = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="[SPEC | FOLDER]...",
        help="Specs or folders of specs (default: those shipped, in this folder, and in all projects of the lab).",
    ),
]
ManyResults = Annotated[
    list[Path] | None,
    typer.Option(
        "--results",
        metavar="FOLDER",
        help="Folder of results; repeatable (default: $GAITSIM_RESULTS, or else results).",
    ),
]


def used_by(
    reference: Reference,
    where: Where = None,
    results: ManyResults = None,
    library: Libraries = None,
    json: Json = False,
) -> None:
    """List the specs and results that use a component or a table. Each has the version of the component.

    Example: gaitsim library used-by muscle/geyer2003
    """
    from gaitsim.components.find import display_path
    from gaitsim.study.records import SHORT
    from gaitsim.study.uses import using_results, using_specs

    scope, talk = scope_of(where, results, library), console.ConsoleListener(json)
    version = scope.version(reference)[:SHORT]
    rows = [("spec", one.archived.name, one.version, "") for one in using_specs(reference, scope, talk)]
    rows += [
        ("result", display_path(r.folder), r.version, r.created[:10]) for r in using_results(reference, scope, talk)
    ]
    if json:
        users = [dict(zip(("what", "name", "version", "created"), row, strict=True)) for row in rows]
        console.give_json({"use": reference, "version": version, "users": users})
        return
    table = [(what, name, _version(one, version), made) for what, name, one, made in rows]
    console.give_table(["what", "name", "version", "made"], table)
    console.give(f"{reference} is {version} now, used by {len(rows)}")


def test(
    reference: Reference,
    where: Where = None,
    results: ManyResults = None,
    trust: Trust = False,
    library: Libraries = None,
    json: Json = False,
) -> int:
    """Run all specs and results that use a component, and compare. They run with its current version.

    Specs are compared with their records, and results, with the component put in the place of their copies, with
    themselves. Do this before a changed component is accepted.

    Examples:

    gaitsim library test muscle/geyer2003

    gaitsim library test muscle/geyer2003 --library alice/components
    """
    from gaitsim.study.acceptance import tested

    found = list(tested(reference, scope_of(where, results, library), trust, console.ConsoleListener(json)))
    wrong = [one for one in found if one.state in ("differs", "error")]
    if json:
        console.give_json(
            {"use": reference, "status": "differs" if wrong else "holds", "users": [tested_data(t) for t in found]}
        )
        return ExitCode.FAILED if wrong else 0
    give_tested(reference, found)
    return ExitCode.FAILED if wrong else 0


def history(
    reference: Reference,
    where: Where = None,
    results: ManyResults = None,
    library: Libraries = None,
    json: Json = False,
) -> None:
    """List the versions of a component: in git, now, and in results.

    Example: gaitsim library history muscle/geyer2003
    """
    from gaitsim.study.lineage import history as versions_of
    from gaitsim.study.uses import using_results, using_specs

    scope, talk = scope_of(where, results, library), console.ConsoleListener(json)
    copies = list(using_results(reference, scope, talk))
    found = versions_of(reference, scope.library(), copies, using_specs(reference, scope, talk))
    if json:
        console.give_json({"use": reference, "versions": [vars(one) for one in found]})
        return
    rows = [(v.digest, v.date[:10], v.origin, "yes" if v.present else "", _few(v.users)) for v in found]
    console.give_table(["version", "since", "from", "now", "used by"], rows)


_WORDS = {
    "holds": "as recorded",
    "differs": "differs",
    "same": "the same version: nothing to run",
    "unrecorded": "no record: gaitsim archive record writes one",
    "error": "cannot be run",
}


def give_tested(reference: str, found: Sequence[Effect]) -> None:
    """Print the results of a component's users with its present version; to stderr what could not be run."""
    wrong = [one for one in found if one.state in ("differs", "error")]
    rows = [row for one in found for row in difference_rows(one.name, one.differs)]
    if rows:
        console.give_table(DIFFERENCE_COLUMNS, rows)
        console.give("")
    console.give_table(
        ["what", "name", "made with", "now"], [(t.what, t.name, t.before, _WORDS[t.state]) for t in found]
    )
    compared = [one for one in found if one.state in ("differs", "error", "holds")]
    console.give(f"{len(compared) - len(wrong)} of {len(compared)} users of {reference} do what was recorded")
    for one in wrong:
        if one.error:
            console.say_error(one.error)


def scope_of(where: list[str] | None, results: list[Path] | None, library: list[Path] | None) -> Scope:
    """The scope that options describe."""
    from gaitsim.study.uses import Scope

    return Scope(tuple(where or ()), tuple(results or [results_folder()]), tuple(library or ()))


def _version(one: str, now: str) -> str:
    return one if one == now else f"{one} (another)"


def _few(names: tuple[str, ...]) -> str:
    return ", ".join(names if len(names) < 4 else [*names[:3], f"{len(names) - 3} more"])


def tested_data(one: Effect) -> dict[str, object]:
    """The result of one user as data."""
    return {
        "what": one.what,
        "name": one.name,
        "made_with": one.before,
        "state": one.state,
        "differs": [difference_data(d) for d in one.differs],
        **({"errors": console.error_data(one.error)["errors"]} if one.error else {}),
    }
