"""gaitsim optimize: tune a spec on all cores or on a cluster; continue an interrupted search."""

from __future__ import annotations

import shlex
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, ModeName, Results, Set, Spec, Trust, opening
from gaitsim.errors import alternatives, command
from gaitsim.folders import results_folder
from gaitsim.optimization.algorithms import ALGORITHMS, DEFAULT

if TYPE_CHECKING:
    from gaitsim.optimization.evaluation import Evaluation
    from gaitsim.optimization.search import Progress
    from gaitsim.study.adoption import Adoption
    from gaitsim.study.tuning import Tuning
    from gaitsim.study.workplace import Workplace

_INTERRUPTED = 130
_ALGORITHMS = alternatives(f"{name} (default)" if name == DEFAULT else name for name in ALGORITHMS)


def optimize(
    spec: Spec,
    algorithm: Annotated[str | None, typer.Option(help=f"Search algorithm: {_ALGORITHMS}.")] = None,
    population: Annotated[int | None, typer.Option(help="Candidates per generation.")] = None,
    generations: Annotated[int | None, typer.Option(help="Maximum number of generations.")] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of the random numbers.")] = None,
    workers: Annotated[
        int | None, typer.Option(help="Number of processes; 0 uses this process (default: all cores).")
    ] = None,
    cluster: Annotated[bool, typer.Option("--cluster", help="Use the workers of a running Dask scheduler.")] = False,
    scheduler: Annotated[str | None, typer.Option(metavar="ADDRESS", help="Address of the scheduler.")] = None,
    scheduler_file: Annotated[Path | None, typer.Option(metavar="FILE", help="File written by the scheduler.")] = None,
    mode: Annotated[ModeName | None, typer.Option(help="rapid: native code; normal: plain Python.")] = None,
    smoke: Annotated[bool, typer.Option("--smoke", help="Short trial: two generations of four candidates.")] = False,
    resume: Annotated[bool, typer.Option("--resume", help="Continue the newest search of this spec.")] = False,
    origin: Annotated[
        str | None, typer.Option("--from", metavar="WHERE", help="Start at tuned, middle (of the bounds), or a result.")
    ] = None,
    adopt: Annotated[bool, typer.Option("--adopt", help="Write the best values to a file beside the spec.")] = False,
    force: Annotated[
        bool, typer.Option("--force", help="With --adopt: replace even values that score better.")
    ] = False,
    results: Results = None,
    trust: Trust = False,
    settings: Set = None,
    library: Libraries = None,
    json: Json = False,
) -> int:
    """Tune the parameters of a spec. Every evaluation is saved, and an interrupted search can continue.

    Examples:

    gaitsim optimize specs/hopping_geyer2003.yaml --seed 1

    gaitsim optimize specs/hopping_geyer2003.yaml --workers 0 --mode normal --smoke

    gaitsim optimize specs/hopping_geyer2003.yaml --cluster --scheduler tcp://127.0.0.1:8786

    gaitsim optimize specs/hopping_geyer2003.yaml --resume
    """
    from gaitsim.errors import ExitCode
    from gaitsim.study.adoption import adopted
    from gaitsim.study.searches import Request, check_adoption, resumed, started
    from gaitsim.study.workplace import Workplace

    chosen = opening(spec, settings, library, tuned=False, trusted=trust, results=results)
    check_adoption(chosen, adopt, force)
    request = Request(
        opening=chosen,
        algorithm=algorithm,
        population=population,
        generations=generations,
        seed=seed,
        mode=mode.value if mode else None,
        smoke=smoke,
        origin=origin,
    )
    workplace = Workplace(workers, cluster, scheduler, scheduler_file)
    workplace.check()
    tuning = (resumed if resume else started)(request, results_folder(results))
    for notice in tuning.notices:
        console.say(notice)
    began = time.perf_counter()
    try:
        progress = _search(tuning, workplace, may_discard=not resume)
    except KeyboardInterrupt:
        return _interrupted(tuning, workplace, json)
    wall = time.perf_counter() - began
    adoption = adopted(tuning, request, workplace, progress, force) if adopt else None
    _report(tuning, progress, wall, json, adoption)
    return 0 if adoption is None or adoption.written else ExitCode.USAGE


def _search(tuning: Tuning, workplace: Workplace, may_discard: bool) -> Progress:
    """Run the search with one line of progress. Errors say how to continue."""
    from gaitsim.cli.progress import ProgressLine
    from gaitsim.cluster.unreachable import ClusterError
    from gaitsim.results.store import CannotSave

    line = ProgressLine(tuning.generations)
    try:
        return tuning.run(workplace, line.update, console.say)
    except (ClusterError, CannotSave) as error:
        if may_discard and isinstance(error, ClusterError) and tuning.discard_if_empty():
            raise
        raise type(error)(f"{error} What was evaluated is saved. To continue: {_again(tuning, workplace)}") from error
    finally:
        line.close()


def _interrupted(tuning: Tuning, workplace: Workplace, json: bool) -> int:
    again = _again(tuning, workplace)
    console.say(f"interrupted; everything is saved. To continue: {again}")
    if json:
        console.give_json({"status": "interrupted", "result": str(tuning.folder), "continue": again})
    return _INTERRUPTED


def _again(tuning: Tuning, workplace: Workplace) -> str:
    """The command that continues the search in the same workplace."""
    return shlex.join(["gaitsim", "optimize", str(tuning.folder), "--resume", *workplace.arguments])


def _failure_data(count: int, example: Evaluation) -> dict[str, object]:
    from gaitsim.optimization.failures import reason_of

    place = example.candidate.name
    return {"count": count, "status": example.verdict.status, "reason": reason_of(example), "candidate": place}


def _report(tuning: Tuning, progress: Progress, wall: float, json: bool, adoption: Adoption | None) -> None:
    from gaitsim.optimization.failures import reason_of

    best = progress.best
    assert best is not None
    if adoption:
        console.say(adoption.message)
    if json:
        console.give_json(
            {
                "result": str(tuning.folder),
                "best_score": best.verdict.score,
                "evaluations": progress.evaluations,
                "generations": progress.generation,
                "failed": progress.failed,
                "failures": [_failure_data(count, example) for count, example in progress.failures.most_common],
                "wall_seconds": wall,
                "stop": progress.stop,
                **({"adopted": adoption.written} if adoption else {}),
            }
        )
        return
    rows = [
        (v.address, console.formatted(v.unit.of(x)), v.unit.text, f"[{v.unit.of(v.low):g}, {v.unit.of(v.high):g}]")
        for v, x in zip(tuning.problem.variables, best.candidate.x, strict=True)
    ]
    console.give_table(["tuned", "best", "unit", "bounds"], rows)
    score = console.formatted(best.verdict.score)
    console.give(
        f"best score {score} (candidate {best.candidate.name}) after {progress.evaluations} evaluations in "
        f"{progress.generation} generations, {progress.failed} failed, {wall:.3g} s of wall time"
    )
    for count, example in progress.failures.most_common:
        look = shlex.join(["gaitsim", "run", str(tuning.folder), "--candidate", example.candidate.name])
        console.give(f"{count} failed: {reason_of(example)}; see such as: {look}")
    console.give(f"stopped: {progress.stop}")
    console.say(f"saved in {tuning.folder}; see it: {command('run', tuning.folder)}")
