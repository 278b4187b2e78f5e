"""gaitsim limit: find by bisection how far numbers of a spec can be varied before a run fails."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, ModeName, Results, Set, Spec, Trust, opening
from gaitsim.errors import command
from gaitsim.folders import results_folder

if TYPE_CHECKING:
    from gaitsim.study.limits import Limit, LimitRuns


def limit(
    spec: Spec,
    vary: Annotated[
        list[str] | None,
        typer.Option(metavar="ADDRESS=FROM:TO", help="Address and range; the first end must succeed; repeatable."),
    ] = None,
    over: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS=VALUES",
            help="Find all limits at each value of another number, as 0 deg,30 deg or as low:high:count.",
        ),
    ] = None,
    until: Annotated[
        str | None,
        typer.Option(metavar="METRIC=VALUE", help="Limit of a metric (default: the run must complete)."),
    ] = None,
    tolerance: Annotated[
        float | None, typer.Option(metavar="SHARE", help="Precision, as a share of the range (default: 0.01).")
    ] = None,
    points: Annotated[
        int | None,
        typer.Option(metavar="COUNT", help="Number of values in the scan, including both ends (default: 9)."),
    ] = None,
    mode: Annotated[
        ModeName | None,
        typer.Option(help="rapid: native code; normal: plain Python, for debugging (default: rapid)."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Continue the interrupted search for limits in a result.")
    ] = False,
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
    """Find the largest disturbance that a model survives. Disturbances are pushes, slopes, steps or noise.

    Each --vary is varied alone: first a scan of its range, then bisection at the first failure.

    With --over, limits over an angle become a polar figure: gaitsim analyze RESULT.

    Every run is saved as it ends, and an interrupted search can continue.

    Examples:

    gaitsim limit specs/walking_geyer2010_perturbed.yaml --vary push.strength='0 N:1000 N'

    gaitsim limit specs/walking_song2015_perturbed.yaml --vary push.strength='0 N:600 N'
    --over push.azimuth='0 deg:330 deg:12'

    gaitsim limit results/2026-11-22-walking_geyer2010_perturbed-3f9c --resume
    """
    from gaitsim.study.new_limits import new_or_resumed

    opened = opening(spec, settings, library, tuned=not start, trusted=trust, candidate=candidate, results=results)
    talk = console.ConsoleListener(json)
    asked = {
        "vary": vary,
        "over": over,
        "until": until,
        "tolerance": tolerance,
        "points": points,
        "mode": mode,
        "from": origin,
    }
    runs = new_or_resumed(opened, asked, resume, None if no_save else results_folder(results), talk)
    try:
        runs.run(talk)
    except KeyboardInterrupt:
        if runs.folder:
            console.say(f"interrupted; to continue: {command('limit', runs.folder, '--resume')}")
        raise
    _report(runs, runs.folder, json)
    return console.code_after(runs.saver.error, 0)


def _report(runs: LimitRuns, folder: Path | None, json: bool) -> None:
    if json:
        rows = [_data(limit, runs) for limit in runs.limits]
        console.give_json({"limits": rows, "mode": runs.mode, "result": str(folder) if folder else None})
        return
    columns = ["address", "from", "to", "last that holds", "first that does not", "how that ends", "runs"]
    console.give_table([*runs.over, *columns], [_row(limit, runs) for limit in runs.limits])
    for limit in runs.limits:
        if limit.first is None:
            console.say(f"{limit.name}: it holds up to {limit.at(1)}; to find a limit, go further.")
        if limit.beyond:
            tried = ", ".join(limit.beyond)
            console.say(f"{limit.name}: beyond its first limit it holds again at {tried}; there is no one limit.")
    if folder:
        console.say(f"saved in {folder}; see a run: {command('run', folder, '--candidate', 'NUMBER')}")


def _row(limit: Limit, runs: LimitRuns) -> tuple[str, ...]:
    ending = runs.until.ending_of(limit.ending) if limit.ending else "-"
    count = str(len(limit.outcomes))
    ends = limit.at(0), limit.at(1), limit.last, limit.first or "-"
    return *limit.beside.values(), limit.address, *ends, ending, count


def _data(limit: Limit, runs: LimitRuns) -> dict[str, Any]:
    return {
        "address": limit.address,
        "over": dict(limit.beside),
        "from": limit.at(0),
        "to": limit.at(1),
        "last": limit.last,
        "first": limit.first,
        "ending": runs.until.ending_of(limit.ending) if limit.ending else None,
        "beyond": limit.beyond,
        "runs": [
            {"value": limit.at(share), "holds": limit.bracket.held[share], "ending": runs.until.ending_of(outcome)}
            for share, outcome in sorted(limit.outcomes.items())
        ],
    }
