"""gaitsim results: list, show and verify what was kept."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Trust
from gaitsim.folders import results_folder
from gaitsim.whole import PARTIAL

app = typer.Typer(help="List, show and verify results.", no_args_is_help=True, rich_markup_mode=None)
_FAILED = 4
Folder = Annotated[Path, typer.Argument(metavar="RESULT", help="A result folder.")]


@app.command("list")
def list_results(
    folder: Annotated[
        Path | None,
        typer.Argument(metavar="[FOLDER]", help="Folder of the results (default: $GAITSIM_RESULTS, or else results)."),
    ] = None,
    json: Json = False,
) -> None:
    """List results, oldest first.

    Example: gaitsim results list
    """
    made = [path.parent for path in sorted(results_folder(folder).glob("*/manifest.json"))]
    rows = [_summary(path) for path in made if path.suffix != PARTIAL]
    rows.sort(key=lambda row: str(row["created"]))
    if json:
        console.give_json({"results": rows})
        return
    columns = ["result", "kind", "status", "best score", "evaluations", "created"]
    cells = [
        (r["result"], r["kind"], r["status"], console.shown(r["best_score"]), str(r["evaluations"] or ""), r["created"])
        for r in rows
    ]
    console.give_table(columns, cells)


@app.command("show")
def show_result(folder: Folder, json: Json = False) -> None:
    """Show one result: origin, search, best values.

    Example: gaitsim results show results/2026-11-22-hopping-3f9c
    """
    from gaitsim.analysis.searches.convergence import tuned_in
    from gaitsim.results.manifest import read_manifest

    manifest = read_manifest(folder)
    if json:
        console.give_json({"result": str(folder), **manifest})
        return
    for key in ("name", "kind", "status", "mode", "created", "gaitsim", "best_score", "evaluations", "failed", "stop"):
        if key in manifest:
            console.give(f"{key:<12} {manifest[key]}")
    columns = ("low", "high", "start", "best", "mean", "std")
    tuned = tuned_in(folder, manifest)
    rows = [(row.address, row.unit, *(console.shown(getattr(row, name)) for name in columns)) for row in tuned]
    if rows:
        console.give("")
        console.give_table(["address", "unit", *columns], rows)


@app.command("verify")
def verify(
    folder: Folder,
    everything: Annotated[
        bool, typer.Option("--all", help="Verify every candidate, not only some and the best.")
    ] = False,
    trust: Trust = False,
    json: Json = False,
) -> int:
    """Run candidates again from the result's own copies and compare bit for bit.

    Example: gaitsim results verify results/2026-11-22-hopping-3f9c
    """
    from gaitsim.optimization.journal import old_form_notices
    from gaitsim.results.manifest import changed_versions, read_result
    from gaitsim.results.trust import check_trust
    from gaitsim.study.verify import verified

    manifest, bundle = read_result(folder)
    check_trust(bundle, trust)
    changed = changed_versions(manifest)
    for notice in old_form_notices(folder) if manifest["kind"] == "optimize" else ():
        console.say(notice)
    checks = list(verified(bundle, manifest, everything))
    wrong = [check for check in checks if check.differs]
    if changed:
        console.say(f"other versions than when it was made: {', '.join(changed)}")
    if json:
        data = [{"candidate": c.name, "differs": list(c.differs)} for c in checks]
        status = "differs" if wrong else "reproduced"
        console.give_json({"result": str(folder), "status": status, "checked": data, "versions": changed})
    else:
        for check in wrong:
            console.give(f"{check.name}: {'; '.join(check.differs)}")
        console.give(f"{folder}: {len(checks) - len(wrong)} of {len(checks)} runs reproduced bit for bit")
    return _FAILED if wrong else 0


def _summary(folder: Path) -> dict[str, Any]:
    """A result in the list; one whose manifest cannot be read is there too, as damaged."""
    from gaitsim.results.manifest import BadResult, recorded_manifest

    try:
        manifest = recorded_manifest(folder)
    except BadResult:
        manifest = {"kind": "?", "status": "damaged", "created": ""}
    keys = ("kind", "status", "best_score", "evaluations", "created")
    return {"result": str(folder), **{key: manifest.get(key) for key in keys}}
