"""gaitsim run: simulate a spec once, once for each row of a study, or once for each draw around its tuned values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import RESULTS, Json, Libraries, ModeName, Set, Spec, Trust, seconds_of
from gaitsim.errors import SimulationFailed, command
from gaitsim.study.keeping import Keeping
from gaitsim.study.opening import open_source

if TYPE_CHECKING:
    from gaitsim.model import Model
    from gaitsim.optimization.draws import Draws
    from gaitsim.simulation.outcome import Outcome
    from gaitsim.spec.study import Variant
    from gaitsim.study.starts import Starts

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
    start: Annotated[bool, typer.Option("--start", help="Ignore the tuned values beside the spec.")] = False,
    trust: Trust = False,
    library: Libraries = None,
    json: Json = False,
) -> int:
    """Simulate a spec, or a candidate of a result, and print its metrics.

    Examples:

    gaitsim run specs/hopping_geyer2003.yaml

    gaitsim run specs/hopping_geyer2003.yaml --vary feedback.gain=1:15:8

    gaitsim run specs/walking_geyer2010.yaml --draws 10 --within '1 %' --seed 1

    gaitsim run specs/hopping_geyer2003.yaml --out hop.csv --every '10 ms'

    gaitsim run results/2026-11-22-hopping-3f9c --candidate 2
    """
    from gaitsim.cli.draws import drawn_models, draws_asked
    from gaitsim.errors import Usage
    from gaitsim.spec.study import variants
    from gaitsim.study.starts import Starts

    drawn = draws_asked(draws, within, seed, vary or [], out)
    source = open_source(spec, settings, library, tuned=not start, trusted=trust, candidate=candidate)
    rows = variants(source.document, vary or [])
    if out is not None and len(rows) > 1:
        raise Usage("--out writes one trajectory; drop --vary or study:, or --set one value.")
    _check_places(out, no_save)
    models = [source.model(row.document) for row in rows]
    spacing = _spacing(every, out, models)
    _say(dict.fromkeys([*source.notices, *(notice for model in models for notice in model.notices)]))
    starts = Starts(source)
    each = drawn_models(models, drawn, spec) if drawn else models
    rows = rows * drawn.count if drawn else rows
    single = len(rows) == 1 and not rows[0].settings
    keeping = Keeping(None if no_save else source, models, mode.value, drawn)
    outcomes: list[Outcome] = []
    try:
        for row, outcome in zip(rows, _outcomes(each, mode, starts, single, out is not None, json), strict=True):
            outcomes.append(outcome)
            keeping.add(row.settings, outcome)
        keeping.close()
    except KeyboardInterrupt:
        keeping.close("interrupted")
        if outcomes:
            _report(rows[: len(outcomes)], outcomes, models, mode, keeping.folder, json, drawn)
        raise
    if out is not None and outcomes[0].trajectory is not None:
        from gaitsim.results.store import save_trajectory

        with keeping.noting():
            save_trajectory(out, outcomes[0] if spacing is None else outcomes[0].every(spacing))
    _report(rows, outcomes, models, mode, keeping.folder, json, drawn)
    _say_endings(rows, outcomes, drawn)
    return keeping.code(_FAILED if all(outcome.status == "failed" for outcome in outcomes) else 0)


def _check_places(out: Path | None, no_save: bool) -> None:
    """What will not be written is said before anything is simulated."""
    from gaitsim.results.store import CannotSave

    if out is not None and out.is_dir():
        raise CannotSave(f"{out}: this is a folder; name a file in it, such as --out {out / 'trajectory.csv'}.")
    blocked = next((folder for folder in out.parents if folder.is_file()), None) if out is not None else None
    if blocked is not None:
        raise CannotSave(f"{out}: {blocked} is a file, so nothing can be written below it; choose another --out.")
    if not no_save and RESULTS.exists() and not RESULTS.is_dir():
        rule = "this is a file, and results go into a folder of that name"
        raise CannotSave(f"{RESULTS}: {rule}; rename the file, or use --no-save.")


def _spacing(every: str | None, out: Path | None, models: Sequence[Model]) -> float | None:
    """Seconds from one instant of --out to the next; None for all. Errors: Usage, before anything is simulated."""
    from gaitsim.errors import Usage
    from gaitsim.simulation.outcome import steps_in

    spacing = seconds_of("--every", every)
    if spacing is not None:
        if out is None:
            raise Usage(f"--every {every}: this is of --out; name a file, such as --out run.csv, or leave it out.")
        steps_in(spacing, models[0].simulate.step)
    return spacing


def _outcomes(
    models: Sequence[Model], mode: ModeName, starts: Starts, single: bool, recorded: bool, quiet: bool
) -> Iterator[Outcome]:
    """The outcomes of the models, in their order, as they end."""
    from gaitsim.simulation.batch import run_all
    from gaitsim.simulation.run import Simulator

    if single:
        simulator = Simulator(models[0], mode.value)
        starts.look_at(simulator)
        _say(starts.warnings)
        with console.waiting("simulating", quiet):
            outcome = simulator.run(recorded=recorded)
        yield outcome
        return
    hear = console.progress("runs", quiet)
    for count, outcome in enumerate(run_all(models, mode.value, starts.look_at), start=1):
        if count == 1:
            _say(starts.warnings)
        hear(count, len(models))
        yield outcome


def _say(lines: Iterable[str]) -> None:
    for line in lines:
        console.say(line)


def _report(
    rows: Sequence[Variant],
    outcomes: Sequence[Outcome],
    models: Sequence[Model],
    mode: ModeName,
    folder: Path | None,
    json: bool,
    draws: Draws | None,
) -> None:
    from gaitsim.cli.draws import drawn_data, give_draws

    single = len(rows) == 1 and not rows[0].settings
    if json:
        units = {name: unit for model in models for name, unit in model.metrics.items()}
        tail = {"units": units, "mode": mode.value, "result": str(folder) if folder else None}
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


def _say_endings(rows: Sequence[Variant], outcomes: Sequence[Outcome], draws: Draws | None) -> None:
    """Which runs failed, and why; of draws also which ones were stopped."""
    for number, (row, outcome) in enumerate(zip(rows, outcomes, strict=True), start=1):
        words = [f"{address} = {value}" for address, value in row.settings.items()]
        which = f"draw {number}: " if draws else f"{', '.join(words)}: " if words else ""
        if outcome.status == "failed":
            console.say(f"{which}failed: {outcome.reason}")
        elif outcome.status == "stopped" and draws:
            console.say(f"{which}stopped by {outcome.reason} at {outcome.simulated_seconds:.4g} s")


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
    rows = [(name, console.shown(value), units[name]) for name, value in outcome.metrics.items()]
    if outcome.score is not None:
        rows.append(("score (a cost)", console.shown(outcome.score), ""))
    console.give_table(["metric", "value", "unit"], rows)
    seconds, wall = outcome.simulated_seconds, outcome.wall_seconds
    by = f" by {outcome.reason}" if outcome.status == "stopped" else ""
    console.give(
        f"{outcome.status}{by}: {seconds:g} s in {outcome.steps} steps, "
        f"{wall:.3g} s of wall time, {seconds / wall:.3g} x real time"
    )


def _print_table(rows: Sequence[Variant], outcomes: Sequence[Outcome], models: Sequence[Model]) -> None:
    from gaitsim.model import headed, headline_metrics

    addresses = list(dict.fromkeys(address for row in rows for address in row.settings))
    # A table has no room for all; --json has.
    names = headline_metrics(dict.fromkeys(name for outcome in outcomes for name in outcome.metrics))
    table = [
        (
            *(row.settings.get(address, "") for address in addresses),
            outcome.status,
            *(console.shown(outcome.metrics.get(name)) for name in names),
        )
        for row, outcome in zip(rows, outcomes, strict=True)
    ]
    console.give_table([*addresses, "status", *(headed(name, models) for name in names)], table)
