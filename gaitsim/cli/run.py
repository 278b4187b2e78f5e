"""gaitsim run: simulate a spec once, once for each row of a study, or once for each draw."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, ModeName, Results, Set, Spec, Trust, opening
from gaitsim.errors import SimulationFailed, command
from gaitsim.folders import results_folder

if TYPE_CHECKING:
    from gaitsim.model import Model
    from gaitsim.simulation.outcome import Outcome
    from gaitsim.spec.study import Variant
    from gaitsim.study.runs import Runs

_FAILED = 4


def run(
    spec: Spec,
    mode: Annotated[
        ModeName, typer.Option(help="rapid: native code; normal: plain Python, for debugging.")
    ] = ModeName.rapid,
    settings: Set = None,
    vary: Annotated[
        list[str] | None,
        typer.Option(metavar="ADDRESS=VALUES", help="Values as low:high:count or a,b,c, one run each; repeatable."),
    ] = None,
    draws: Annotated[
        int | None,
        typer.Option(metavar="COUNT", help="Number of runs with randomly changed tuned values."),
    ] = None,
    within: Annotated[
        str | None, typer.Option(metavar="SHARE", help="With --draws: largest relative change (default: '1 %').")
    ] = None,
    seed: Annotated[int | None, typer.Option(help="With --draws: seed of the random numbers (default: 1).")] = None,
    out: Annotated[Path | None, typer.Option(metavar="FILE", help="Write every signal to a CSV file.")] = None,
    every: Annotated[
        str | None,
        typer.Option(metavar="TIME", help="With --out: time between instants, such as '10 ms' (default: every step)."),
    ] = None,
    no_save: Annotated[bool, typer.Option("--no-save", help="Do not save a result folder.")] = False,
    candidate: Annotated[
        str | None,
        typer.Option(
            metavar="WHICH", help="Candidate of a result: best, a rank, GENERATION:INDEX, or the number of a run."
        ),
    ] = None,
    results: Results = None,
    start: Annotated[bool, typer.Option("--start", help="Ignore the tuned values beside the spec.")] = False,
    trust: Trust = False,
    library: Libraries = None,
    json: Json = False,
) -> int:
    """Simulate a spec or a candidate of a result, and print metrics.

    Examples:

    gaitsim run specs/hopping_geyer2003.yaml

    gaitsim run specs/hopping_geyer2003.yaml --vary feedback.gain=1:15:8

    gaitsim run specs/walking_geyer2010.yaml --draws 10 --within '1 %' --seed 1

    gaitsim run specs/hopping_geyer2003.yaml --out hop.csv --every '10 ms'

    gaitsim run results/2026-11-22-hopping-3f9c --candidate 2
    """
    from gaitsim.study.draws import draws_asked
    from gaitsim.study.runs import Places, prepared

    samples = draws_asked(draws, within, seed, vary or [], out)
    opened = opening(spec, settings, library, tuned=not start, trusted=trust, candidate=candidate, results=results)
    places, talk = Places(None if no_save else results_folder(results), out, every), console.ConsoleListener(json)
    runs = prepared(opened, vary or [], samples, mode.value, places, talk)
    try:
        runs.run(talk)
    except KeyboardInterrupt:
        if runs.outcomes:
            _report(runs, json)
        raise
    _report(runs, json)
    _say_endings(runs)
    return console.code_after(runs.unsaved, _FAILED if runs.failed else 0)


def _report(runs: Runs, json: bool) -> None:
    from gaitsim.cli.draws import drawn_data, give_draws

    outcomes, models, draws, folder = runs.outcomes, runs.models, runs.draws, runs.folder
    rows = runs.rows[: len(outcomes)]
    single = len(rows) == 1 and not rows[0].settings
    if json:
        units = {name: unit for model in models for name, unit in model.metrics.items()}
        tail = {"units": units, "mode": runs.mode, "result": str(folder) if folder else None}
        tables = [_data(outcome) for outcome in outcomes]
        if draws:
            console.give_json({"status": _overall(outcomes), **drawn_data(draws, models[0], outcomes, tables), **tail})
        elif single:
            console.give_json(tables[0] | tail)
        else:
            table = [{"settings": row.settings, **data} for row, data in zip(rows, tables, strict=True)]
            console.give_json({"status": _overall(outcomes), "rows": table, **tail})
        return
    if draws:
        give_draws(draws, models[0], outcomes)
    elif single and outcomes[0].status != "failed":
        _print_one(outcomes[0], models[0])
    elif not single:
        _print_table(rows, outcomes, models)
    if folder:
        look = f"; see a draw: {command('run', folder, '--candidate', 'NUMBER')}" if draws else ""
        console.say(f"saved in {folder}{look}")


def _say_endings(runs: Runs) -> None:
    """Print which runs failed, and why; of draws also which ones were stopped."""
    for number, (row, outcome) in enumerate(zip(runs.rows, runs.outcomes, strict=True), start=1):
        settings = [f"{address} = {value}" for address, value in row.settings.items()]
        which = f"draw {number}: " if runs.draws else f"{', '.join(settings)}: " if settings else ""
        if outcome.status == "failed":
            console.say(f"{which}failed: {outcome.reason}")
        elif outcome.status == "stopped" and runs.draws:
            console.say(f"{which}stopped by {outcome.ending} at {outcome.simulated_seconds:.4g} s")


def _overall(outcomes: Sequence[Outcome]) -> str:
    return "failed" if all(outcome.status == "failed" for outcome in outcomes) else "completed"


def _data(outcome: Outcome) -> dict[str, Any]:
    failed = {"errors": console.error_data(SimulationFailed(outcome.reason))["errors"]}
    return {
        "status": outcome.status,
        "reason": outcome.reason or None,
        **(failed if outcome.status == "failed" else {}),
        "score": outcome.score,
        "metrics": dict(outcome.metrics),
        "simulated_seconds": outcome.simulated_seconds,
        "wall_seconds": outcome.wall_seconds,
        "steps": outcome.steps,
    }


def _print_one(outcome: Outcome, model: Model) -> None:
    units = model.metrics
    rows = [(name, console.formatted(value), units[name]) for name, value in outcome.metrics.items()]
    if outcome.score is not None:
        rows.append(("score (a cost)", console.formatted(outcome.score), ""))
    console.give_table(["metric", "value", "unit"], rows)
    seconds, wall = outcome.simulated_seconds, outcome.wall_seconds
    by = f" by {outcome.ending}" if outcome.status == "stopped" else ""
    console.give(
        f"{outcome.status}{by}: {seconds:g} s in {outcome.steps} steps, "
        f"{wall:.3g} s of wall time, {seconds / wall:.3g} x real time"
    )


def _print_table(rows: Sequence[Variant], outcomes: Sequence[Outcome], models: Sequence[Model]) -> None:
    from gaitsim.model import headed, headline_metrics

    addresses = list(dict.fromkeys(address for row in rows for address in row.settings))
    # A table has no room for all metrics; --json has them.
    names = headline_metrics(dict.fromkeys(name for outcome in outcomes for name in outcome.metrics))
    table = [
        (
            *(row.settings.get(address, "") for address in addresses),
            outcome.status,
            *(console.formatted(outcome.metrics.get(name)) for name in names),
        )
        for row, outcome in zip(rows, outcomes, strict=True)
    ]
    console.give_table([*addresses, "status", *(headed(name, models) for name in names)], table)
