"""gaitsim limit: how far numbers of a spec can go before a run ends, by bisection."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, ModeName, Results, Set, Spec, Trust, opening
from gaitsim.errors import command
from gaitsim.folders import results_folder

if TYPE_CHECKING:
    from gaitsim.study.limits import Hunt, Limit


def limit(
    spec: Spec,
    vary: Annotated[
        list[str],
        typer.Option(metavar="ADDRESS=FROM:TO", help="Address and range; the first end must succeed; repeatable."),
    ],
    until: Annotated[
        str | None,
        typer.Option(metavar="METRIC=VALUE", help="Limit of a metric (default: the run must complete)."),
    ] = None,
    tolerance: Annotated[float, typer.Option(metavar="SHARE", help="Precision, as a share of the range.")] = 0.01,
    points: Annotated[
        int, typer.Option(metavar="COUNT", help="Number of values in the scan, including both ends.")
    ] = 9,
    mode: Annotated[
        ModeName, typer.Option(help="rapid: native code; normal: plain Python, for debugging.")
    ] = ModeName.rapid,
    settings: Set = None,
    no_save: Annotated[bool, typer.Option("--no-save", help="Do not save a result folder.")] = False,
    origin: Annotated[
        str | None, typer.Option("--from", metavar="RESULT", help="Start at the best values of this result.")
    ] = None,
    candidate: Annotated[
        str | None, typer.Option(metavar="WHICH", help="Candidate of a result: best, a rank, or GENERATION:INDEX.")
    ] = None,
    results: Results = None,
    start: Annotated[bool, typer.Option("--start", help="Ignore the tuned values beside the spec.")] = False,
    trust: Trust = False,
    library: Libraries = None,
    json: Json = False,
) -> int:
    """Find the largest disturbance that a model survives: pushes, slopes, steps, noise.

    Each --vary is varied alone: first a scan of its range, then bisection at the first failure.

    Example: gaitsim limit specs/walking_geyer2010_perturbed.yaml --vary push.strength='0 N:1000 N'
    """
    from gaitsim.study.limits import Scan, hunted

    opened = opening(spec, settings, library, tuned=not start, trusted=trust, candidate=candidate, results=results)
    talk = console.Talk(json)
    hunt = hunted(opened, vary, until, Scan(points, tolerance), origin, mode.value, talk)
    hunt.run(talk.progress("runs"))
    keeping = hunt.kept(None if no_save else results_folder(results))
    _report(hunt, keeping.folder, json)
    return console.code_after(keeping.error, 0)


def _report(hunt: Hunt, folder: Path | None, json: bool) -> None:
    if json:
        rows = [_data(limit, hunt) for limit in hunt.limits]
        console.give_json({"limits": rows, "mode": hunt.mode, "result": str(folder) if folder else None})
        return
    columns = ["address", "from", "to", "last that holds", "first that does not", "how that ends", "runs"]
    console.give_table(columns, [_row(limit, hunt) for limit in hunt.limits])
    for limit in hunt.limits:
        if limit.first is None:
            console.say(f"{limit.address}: it holds up to {limit.at(1)}; to find a limit, go further.")
        if limit.beyond:
            tried = ", ".join(limit.beyond)
            console.say(f"{limit.address}: beyond its first limit it holds again at {tried}; there is no one limit.")
    if folder:
        console.say(f"saved in {folder}; see a run: {command('run', folder, '--candidate', 'NUMBER')}")


def _row(limit: Limit, hunt: Hunt) -> tuple[str, ...]:
    ending = hunt.until.said(limit.ending) if limit.ending else "-"
    runs = str(len(limit.outcomes))
    return limit.address, limit.at(0), limit.at(1), limit.last, limit.first or "-", ending, runs


def _data(limit: Limit, hunt: Hunt) -> dict[str, Any]:
    return {
        "address": limit.address,
        "from": limit.at(0),
        "to": limit.at(1),
        "last": limit.last,
        "first": limit.first,
        "ending": hunt.until.said(limit.ending) if limit.ending else None,
        "beyond": limit.beyond,
        "runs": [
            {"value": limit.at(share), "holds": limit.bracket.held[share], "ending": hunt.until.said(outcome)}
            for share, outcome in sorted(limit.outcomes.items())
        ],
    }
