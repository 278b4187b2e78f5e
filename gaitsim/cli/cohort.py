"""gaitsim cohort: one spec with many bodies and many devices, in one table."""

from __future__ import annotations

import shlex
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, ModeName, Results, Set, Spec, Trust, opening
from gaitsim.errors import ExitCode, Usage, command
from gaitsim.folders import results_folder

if TYPE_CHECKING:
    from gaitsim.simulation.run import Mode
    from gaitsim.study.cohorts import CohortRuns
    from gaitsim.study.opening import Opening
    from gaitsim.study.workplace import Workplace

_MOST = 20  # rows that did not complete, each in a line of its own


def cohort(
    spec: Spec,
    bodies: Annotated[
        Path | None,
        typer.Argument(metavar="BODIES.csv", help="Table of bodies: name, height, mass, sex, or any parameter."),
    ] = None,
    vary: Annotated[
        list[str] | None,
        typer.Option(metavar="ADDRESS=VALUES", help="Values for every body, as low:high:count or a,b,c; repeatable."),
    ] = None,
    retune: Annotated[
        int | None,
        typer.Option(
            metavar="COUNT", help="Tune each row that does not complete, with at most this number of evaluations."
        ),
    ] = None,
    metric: Annotated[list[str] | None, typer.Option(metavar="METRIC", help="Metric to draw; repeatable.")] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of each search (default: the spec's).")] = None,
    workers: Annotated[
        int | None, typer.Option(help="Number of processes; 0 uses this process (default: all cores).")
    ] = None,
    cluster: Annotated[bool, typer.Option("--cluster", help="Use the workers of a running Dask scheduler.")] = False,
    scheduler: Annotated[str | None, typer.Option(metavar="ADDRESS", help="Address of the scheduler.")] = None,
    scheduler_file: Annotated[Path | None, typer.Option(metavar="FILE", help="File written by the scheduler.")] = None,
    mode: Annotated[
        ModeName | None,
        typer.Option(help="rapid: native code; normal: plain Python, for debugging (default: rapid)."),
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Continue the interrupted cohort in a result.")] = False,
    settings: Set = None,
    no_save: Annotated[bool, typer.Option("--no-save", help="Do not save a result folder.")] = False,
    results: Results = None,
    start: Annotated[bool, typer.Option("--start", help="Ignore the tuned values beside the spec.")] = False,
    trust: Trust = False,
    library: Libraries = None,
    json: Json = False,
) -> int:
    """Run a spec for each body of a table and each value of a device. The results are one table.

    An invalid row, or a row whose model falls, does not stop the others. Every row is saved as it ends, and an
    interrupted cohort can continue.

    Examples:

    gaitsim cohort specs/walking_geyer2010.yaml specs/bodies.csv

    gaitsim cohort specs/walking_geyer2010.yaml specs/bodies.csv --retune 200

    gaitsim cohort specs/walking_geyer2010_ankle_spring.yaml specs/bodies.csv
    --vary exo.stiffness='0 N m/rad:240 N m/rad:5'

    gaitsim cohort results/2026-11-26-walking_geyer2010-3f9c --resume
    """
    from gaitsim.study.workplace import Workplace

    opened = opening(spec, settings, library, tuned=not start, trusted=trust, results=results)
    workplace = Workplace(workers, cluster, scheduler, scheduler_file)
    workplace.check()
    asked = {"vary": vary, "retune": retune, "metric": metric, "seed": seed, "mode": mode}
    runs = _resumed(opened, bodies, asked, no_save) if resume else _begun(opened, bodies, asked, no_save, results)
    talk, began = console.ConsoleListener(json), time.perf_counter()
    for notice in runs.notices:
        console.say(notice)
    try:
        runs.run(workplace, talk)
    except KeyboardInterrupt:
        if runs.folder:
            console.say(f"interrupted; to continue: {_again(runs, workplace)}")
        raise
    _report(runs, time.perf_counter() - began, json)
    failed = not any(found.outcome.status != "failed" for found in runs.found.values())
    return console.code_after(runs.saver.error, ExitCode.FAILED if failed else 0)


def _begun(
    opened: Opening, bodies: Path | None, asked: dict[str, Any], no_save: bool, results: Path | None
) -> CohortRuns:
    from gaitsim.study.cohorts import CohortRequest, cohort_runs

    if bodies is None:
        sample = command("cohort", opened.path, "bodies.csv")
        raise Usage(f"there is no table of bodies; name one, such as {sample}, or --resume a result.")
    mode: Mode = "normal" if asked["mode"] == ModeName.normal else "rapid"
    of = CohortRequest(bodies, asked["vary"] or [], asked["retune"] or 0, asked["seed"], asked["metric"] or [])
    return cohort_runs(opened, of, mode, None if no_save else results_folder(results))


def _resumed(opened: Opening, bodies: Path | None, asked: dict[str, Any], no_save: bool) -> CohortRuns:
    from gaitsim.study.cohorts import resumed_cohort

    options = [f"--{name}" for name, value in asked.items() if value is not None]
    conflicting = [*([str(bodies)] if bodies else []), *options, *(["--no-save"] if no_save else [])]
    if conflicting:
        raise Usage(f"{conflicting[0]} begins a new cohort, and --resume continues an old one; leave one out.")
    return resumed_cohort(opened)


def _again(runs: CohortRuns, workplace: Workplace) -> str:
    return shlex.join(["gaitsim", "cohort", str(runs.folder), "--resume", *workplace.arguments])


def _report(runs: CohortRuns, wall: float, json: bool) -> None:
    folder = str(runs.folder) if runs.folder else None
    cells = runs.cells()
    if json:
        rows = [dict(zip(cells.columns, row, strict=True)) for row in cells.rows]
        console.give_json({"endings": runs.counts, "rows": rows, "wall_seconds": wall, "result": folder})
        return
    _give_table(runs)
    counts = ", ".join(f"{count} {ending}" for ending, count in runs.counts.items())
    rows_a_body = len(runs.cohort.rows) // len(runs.bodies)
    count = f"{len(runs.bodies)} bodies x {rows_a_body}: {len(runs.cohort.rows)} rows"
    console.give(f"{count}: {counts}; {wall:.3g} s of wall time")
    for text in _lost(runs)[:_MOST]:
        console.say(text)
    if folder:
        console.say(
            f"saved in {folder}: table.csv, figures; see a row: {command('run', folder, '--candidate', 'NUMBER')}"
        )


def _lost(runs: CohortRuns) -> list[str]:
    """The rows that could not be run; each reason once."""
    lost = {i: found for i, found in sorted(runs.found.items()) if found.outcome.status not in ("completed", "stopped")}
    places: dict[tuple[str, str], list[int]] = {}
    for i, found in lost.items():
        places.setdefault((runs.cohort.rows[i].body, f"{found.ending}: {found.outcome.reason}"), []).append(i + 1)
    return [f"{body} ({_rows(numbers)}) {reason}" for (body, reason), numbers in places.items()]


def _rows(numbers: list[int]) -> str:
    return f"row {numbers[0]}" if len(numbers) == 1 else f"{len(numbers)} rows from {numbers[0]}"


def _give_table(runs: CohortRuns) -> None:
    """Print bodies, settings, how each row ended, and the metrics that were asked for."""
    from gaitsim.model import headed

    cells = runs.cells()
    before = cells.columns.index("reason")
    wanted = [*range(before), *(cells.columns.index(headed(name, [runs.model])) for name in runs.metrics)]
    rows = [
        [cell if isinstance(cell, str) else console.formatted(cell) for cell in (row[i] for i in wanted)]
        for row in cells.rows
    ]
    console.give_table([cells.columns[i] for i in wanted], rows)
