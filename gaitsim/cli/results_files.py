"""gaitsim results note, export, import and remove."""

from __future__ import annotations

import sys
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Results
from gaitsim.errors import command
from gaitsim.folders import results_folder

if TYPE_CHECKING:
    from gaitsim.results.copies import Copy

Folder = Annotated[Path, typer.Argument(metavar="RESULT", help="A result folder.")]


def note(
    folder: Folder,
    words: Annotated[list[str], typer.Argument(metavar="TEXT...", help="Text of the note.")],
    results: Results = None,
) -> None:
    """Add a note to a result, with your name and the day. Notes are not part of its digest.

    Example: gaitsim results note results/2026-11-22-hopping-3f9c 'the reflex of 2003, tuned for height'
    """
    from gaitsim.errors import Usage
    from gaitsim.results.manifest import check_is_result, result_named
    from gaitsim.results.notes import add_note
    from gaitsim.results.provenance import author

    named, text = result_named(folder, results), " ".join(words).strip()
    check_is_result(named)
    if not text:
        raise Usage("this note is empty; write some words.")
    add_note(named, text, author(), date.today().isoformat())
    console.say(f"noted in {named / 'README.md'}")


def export(
    folder: Folder,
    out: Annotated[
        Path | None, typer.Option(metavar="FILE", help="The zip file (default: RESULT.zip in this folder).")
    ] = None,
    results: Results = None,
) -> None:
    """Write a result as one zip file for a colleague. They can verify, resume and analyze it.

    Example: gaitsim results export results/2026-11-22-hopping-3f9c
    """
    from gaitsim.results.manifest import result_named
    from gaitsim.results.packing import pack

    named = result_named(folder, results)
    target = out or Path(f"{named.resolve().name}.zip")
    pack(named, target)
    console.give(str(target))
    console.say(f"your colleague's next: {command('results', 'import', target.name)}")


def import_result(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A zip file that gaitsim results export made.")],
    results: Results = None,
    json: Json = False,
) -> None:
    """Add a colleague's result to yours. The code that it contains is listed, and none of it is run.

    Example: gaitsim results import 2026-11-22-hopping-3f9c.zip
    """
    from gaitsim.components.find import library_folders
    from gaitsim.results.copies import copies
    from gaitsim.results.manifest import changed_makers, read_result
    from gaitsim.results.packing import unpack

    made = unpack(file, results_folder(results))
    manifest, bundle = read_result(made)
    found, changed = copies(bundle, library_folders(None)), changed_makers(manifest)
    if json:
        console.give_json(_imported(made, found, changed))
        return
    rows = [(c.path, c.comparison, "not known to this machine" if c.strange else "") for c in found if not c.same]
    if rows:
        console.give_table(["brings", "in your libraries", "code"], rows)
    same = sum(c.same for c in found)
    console.give(f"{same} of its {len(found)} component files are the same as in your libraries")
    if changed:
        console.say(f"made with others than here: {', '.join(changed)}")
    strange = [str(made / c.path) for c in found if c.strange]
    if strange:
        console.say(f"nothing of it was run. Read its code before --trust runs it: {', '.join(strange)}")
    trust = ["--trust"] if strange else []
    console.say(f"imported as {made}; next: {command('results', 'verify', made, *trust)}")


def _imported(made: Path, found: list[Copy], changed: list[str]) -> dict[str, Any]:
    rows = [{"file": c.path, "library": c.library or None, "same": c.same, "known": not c.strange} for c in found]
    return {"result": str(made), "components": rows, "versions": changed}


def remove(
    folders: Annotated[list[Path], typer.Argument(metavar="RESULT...", help="Result folders.")],
    yes: Annotated[bool, typer.Option("--yes", help="Delete without asking.")] = False,
    results: Results = None,
) -> None:
    """Delete results permanently, after a confirmation.

    Example: gaitsim results remove results/2026-11-22-hopping-3f9c --yes
    """
    from gaitsim.errors import Usage
    from gaitsim.results.manifest import check_is_result, result_named
    from gaitsim.results.removal import remove as remove_result

    named = [result_named(folder, results) for folder in folders]
    for folder in named:
        check_is_result(folder)
    listed = ", ".join(map(str, named))
    if not yes:
        if not sys.stdin.isatty():
            raise Usage(f"nothing was removed: no one can be asked here; to remove {listed}, add --yes.")
        if not typer.confirm(f"Remove {listed} for good?", err=True):
            console.say("nothing was removed")
            return
    for folder in named:
        remove_result(folder)
        console.say(f"removed {folder}")
