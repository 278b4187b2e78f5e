"""gaitsim results: list, show and verify results, and commands on their files."""

from __future__ import annotations

import math
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from gaitsim.cli import compare, console, results_files
from gaitsim.cli.options import Json, Trust
from gaitsim.folders import results_folder

app = typer.Typer(help="List, compare, verify, note, share and remove results.", rich_markup_mode=None)
_FAILED, _BRIEF = 4, 60  # an exit code; letters of a note
Folder = Annotated[Path, typer.Argument(metavar="RESULT", help="A result folder.")]


_ORDERS = StrEnum("_ORDERS", ["created", "name", "score", "evaluations"])


@app.command("list")
def list_results(
    folder: Annotated[
        Path | None,
        typer.Argument(metavar="[FOLDER]", help="Folder of the results (default: $GAITSIM_RESULTS, or else results)."),
    ] = None,
    name: Annotated[
        str | None, typer.Option(metavar="PATTERN", help="Only results of specs with this name, such as 'hop*'.")
    ] = None,
    kind: Annotated[str | None, typer.Option(metavar="KIND", help="Only run, or only optimize.")] = None,
    status: Annotated[str | None, typer.Option(metavar="STATUS", help="Only complete, interrupted or running.")] = None,
    since: Annotated[
        str | None, typer.Option(metavar="DATE", help="Only results of this day and later, such as 2026-11-22.")
    ] = None,
    uses: Annotated[
        str | None,
        typer.Option(metavar="KIND/NAME", help="Only results that use this component, such as muscle/geyer2003."),
    ] = None,
    noted: Annotated[str | None, typer.Option(metavar="TEXT", help="Only results with this text in a note.")] = None,
    sort: Annotated[_ORDERS, typer.Option(help="Order of the rows; the best score is first.")] = _ORDERS.created,
    json: Json = False,
) -> None:
    """List results, oldest first.

    Examples:

    gaitsim results list

    gaitsim results list --name 'hop*' --kind optimize --sort score
    """
    from gaitsim.results.catalog import Filter, listed

    wanted = Filter(name, kind, status, since, uses, noted)
    rows = listed(results_folder(folder), wanted, sort.value)
    if json:
        console.give_json({"results": rows})
        return
    columns = ["result", "kind", "status", "best score", "evaluations", "created", "notes"]
    cells = [
        (
            *(r["result"], r["kind"], r["status"], console.formatted(r["best_score"]), str(r["evaluations"] or "")),
            *(r["created"], _brief(r["notes"])),
        )
        for r in rows
    ]
    console.give_table(columns, cells)


def _brief(notes: str) -> str:
    """The last note in one short line."""
    last = next((line.strip(" -") for line in reversed(notes.splitlines()) if line.strip()), "")
    return last if len(last) <= _BRIEF else f"{last[: _BRIEF - 3]}..."


@app.command("show")
def show_result(folder: Folder, json: Json = False) -> None:
    """Show one result: origin, search, best values.

    Example: gaitsim results show results/2026-11-22-hopping-3f9c
    """
    from gaitsim.analysis.searches.convergence import tuned_in
    from gaitsim.results.manifest import read_manifest
    from gaitsim.results.notes import notes_of

    manifest = read_manifest(folder)
    if json:
        console.give_json({"result": str(folder), **manifest, "notes": notes_of(folder)})
        return
    for key in ("name", "kind", "status", "mode", "created", "gaitsim", "best_score", "evaluations", "failed", "stop"):
        if key in manifest:
            console.give(f"{key:<12} {manifest[key]}")
    if commit := manifest.get("commit"):
        changes = ", with changes that were not committed: changes.diff" if commit["dirty"] else ""
        console.give(f"{'commit':<12} {commit['hash']}{changes}")
    columns = ("low", "high", "start", "best", "mean", "std")
    tuned = tuned_in(folder, manifest)
    rows = [(row.address, row.unit, *(console.formatted(getattr(row, name)) for name in columns)) for row in tuned]
    if rows:
        console.give("")
        console.give_table(["address", "unit", *columns], rows)
    if notes := notes_of(folder):
        console.give(f"\n{notes}")


@app.command("verify")
def verify(
    folder: Folder,
    everything: Annotated[
        bool, typer.Option("--all", help="Verify every candidate, not only the best and a sample.")
    ] = False,
    trust: Trust = False,
    json: Json = False,
) -> int:
    """Run candidates again and compare bit for bit. They run from the result's own copies.

    Example: gaitsim results verify results/2026-11-22-hopping-3f9c
    """
    from gaitsim.optimization.journal import old_form_notices
    from gaitsim.results.manifest import changed_makers, read_result
    from gaitsim.results.trust import check_trust
    from gaitsim.study.verify import verified

    manifest, bundle = read_result(folder)
    check_trust(bundle, trust)
    changed = changed_makers(manifest)
    for notice in old_form_notices(folder) if manifest["kind"] == "optimize" else ():
        console.say(notice)
    checks = list(verified(bundle, manifest, everything))
    wrong = [check for check in checks if check.differs]
    if changed:
        console.say(f"others than when it was made: {', '.join(changed)}")
    if json:
        data = [{"candidate": c.name, "differs": list(c.differs), "largest": c.largest} for c in checks]
        status = "differs" if wrong else "reproduced"
        console.give_json({"result": str(folder), "status": status, "checked": data, "versions": changed})
    else:
        for check in wrong:
            console.give(f"{check.name}: {'; '.join(check.differs)}")
        if wrong:
            console.say(_why(max(check.largest for check in wrong), changed))
        console.give(f"{folder}: {len(checks) - len(wrong)} of {len(checks)} runs reproduced bit for bit")
    return _FAILED if wrong else 0


def _why(largest: float, changed: list[str]) -> str:
    """The message about a result that does not reproduce."""
    far = (
        f"numbers differ by up to {largest:.1e} of their value" if math.isfinite(largest) else "the runs went otherwise"
    )
    if changed:
        return f"{far}; bits are the same only with the same versions and processor, and these are others"
    return f"{far}, with the versions and the processor that made them; please report this as a fault of gaitsim"


app.command("compare")(compare.compare)
app.command("note")(results_files.note)
app.command("export")(results_files.export)
app.command("import")(results_files.import_result)
app.command("remove")(results_files.remove)
