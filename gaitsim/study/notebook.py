"""What a notebook calls: each function does what the command of its name does, and returns what that prints.

Keywords bear the names of options, and errors speak of these. Warnings are logged, and a mistake raises
`gaitsim.errors.GaitsimError`. A run that fails is no error: its outcome says so.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.folders import results_folder
from gaitsim.study.listening import Logged
from gaitsim.study.opening import Opening

if TYPE_CHECKING:
    from gaitsim.optimization.search import Progress
    from gaitsim.simulation.run import Mode
    from gaitsim.study.adoption import Adoption
    from gaitsim.study.analyses import Analysis
    from gaitsim.study.cycles import Cycle
    from gaitsim.study.limits import Hunt
    from gaitsim.study.runs import Runs
    from gaitsim.study.soundness import Soundness
    from gaitsim.study.tuning import Tuning

File = str | Path
Settings = Mapping[str, Any]


def opening(
    path: File,
    set: Settings | None = None,
    library: Sequence[File] = (),
    start: bool = False,
    trust: bool = False,
    candidate: str | None = None,
    results: File | None = None,
) -> Opening:
    """A spec or a result, and how it is opened.

    Args:
        path: A spec, or a result folder.
        set: Values by address: `{"feedback.gain": 3, "simulate.duration": "2 s"}`.
        library: More folders of components.
        start: Ignore tuned values beside the spec.
        trust: Run components of a result that this machine does not know.
        candidate: Of a result: best, a rank, GENERATION:INDEX, or the number of a run.
        results: The folder in which a result's name is looked up; None for the usual one.
    """
    from gaitsim.results.manifest import result_named

    root = None if results is None else Path(results)
    settings = tuple(f"{address}={_text(value)}" for address, value in (set or {}).items())
    named = result_named(Path(path), root)
    return Opening(named, settings, tuple(map(Path, library)), not start, trust, candidate, root)


def run(
    path: File,
    set: Settings | None = None,
    *,
    vary: Mapping[str, str | Sequence[Any]] | None = None,
    draws: int | None = None,
    within: str | None = None,
    seed: int | None = None,
    mode: Mode = "rapid",
    out: File | None = None,
    every: str | None = None,
    save: bool = True,
    results: File | None = None,
    candidate: str | None = None,
    start: bool = False,
    trust: bool = False,
    library: Sequence[File] = (),
) -> Runs:
    """Simulate a spec, or a candidate of a result: once, for each row of a study, or for each draw.

    Args:
        path: A spec, or a result folder.
        set: Values by address: `{"feedback.gain": 3, "simulate.duration": "2 s"}`.
        vary: Values to run, by address: a list, or a range such as "1:15:8".
        draws: So many runs, each with every tuned value a little different, by chance.
        within: Of draws: how different at most, such as "1 %".
        seed: Of draws: the same seed draws the same.
        mode: rapid (native code), or normal (plain Python).
        out: A CSV file for every signal of a single run, in SI.
        every: Of `out`: one instant each "10 ms"; None for all.
        save: Whether a result folder is kept.
        results: Where result folders go, and names are looked up; None for $GAITSIM_RESULTS, or else results.
        candidate: Of a result: best, a rank, GENERATION:INDEX, or the number of a run.
        start: Ignore tuned values beside the spec.
        trust: Run components of a result that this machine does not know.
        library: More folders of components.

    Returns:
        The runs: `outcomes` with status, metrics (in declared units) and score, `table()`, `folder`, `notices`.
        What could not be kept is in `unsaved`. Warnings are logged.

    Raises:
        GaitsimError: The spec, a component, a result or an argument is wrong.
    """
    from gaitsim.study.draws import draws_asked
    from gaitsim.study.runs import Places, prepared

    varied = ranges(vary)
    file = None if out is None else Path(out)
    drawn = draws_asked(draws, within, seed, varied, file)
    opened = opening(path, set, library, start, trust, candidate, results)
    runs = prepared(opened, varied, drawn, mode, Places(_root(results) if save else None, file, every), Logged())
    runs.run(Logged())
    if runs.unsaved:
        Logged().say_error(runs.unsaved)
    return runs


def limit(
    path: File,
    vary: Mapping[str, str],
    set: Settings | None = None,
    *,
    until: str | None = None,
    tolerance: float = 0.01,
    points: int = 9,
    mode: Mode = "rapid",
    save: bool = True,
    results: File | None = None,
    origin: str | None = None,
    candidate: str | None = None,
    start: bool = False,
    trust: bool = False,
    library: Sequence[File] = (),
) -> Hunt:
    """Find how far numbers can go before a run ends, each alone.

    Args:
        path: A spec, or a result folder.
        vary: Ranges by address, from where all is well: `{"push.strength": "0 N:1000 N"}`.
        set: Values by address.
        until: METRIC=VALUE that ends it; None for a run that does not complete.
        tolerance: How exactly, in parts of the range.
        points: Values of the first scan, both ends included.
        mode: rapid or normal.
        save: Whether a result folder is kept.
        results: Where result folders go, and names are looked up; None for $GAITSIM_RESULTS, or else results.
        origin: As `--from`: a result whose best values are the start.
        candidate: Of a result.
        start: Ignore tuned values beside the spec.
        trust: Run components of a result that this machine does not know.
        library: More folders of components.

    Returns:
        What was found: `limits`, each with `address`, `last` (holds), `first` (does not; None if all do) and `beyond`;
        `rows` of every run.

    Raises:
        GaitsimError: An argument or the spec is wrong, a range does not hold at its first end, or nothing can be kept.
    """
    from gaitsim.study.limits import Scan, hunted

    opened = opening(path, set, library, start, trust, candidate, results)
    ranges = [f"{address}={ends}" for address, ends in vary.items()]
    root = _root(results) if save else None
    hunt = hunted(opened, ranges, until, Scan(points, tolerance), origin, mode, root, Logged())
    hunt.run(Logged())
    if hunt.keeping.error:
        raise hunt.keeping.error
    return hunt


def cycle(
    path: File,
    set: Settings | None = None,
    *,
    mode: Mode = "rapid",
    results: File | None = None,
    candidate: str | None = None,
    start: bool = False,
    trust: bool = False,
    library: Sequence[File] = (),
) -> Cycle:
    """Find the periodic gait of a model near its start, and the eigenvalues of its return map there.

    Args:
        path: A spec, or a result folder.
        set: Values by address.
        mode: rapid or normal.
        results: Where names of results are looked up; None for $GAITSIM_RESULTS, or else results.
        candidate: Of a result.
        start: Ignore tuned values beside the spec.
        trust: Run components of a result that this machine does not know.
        library: More folders of components.

    Returns:
        The gait: `start`, `period`, `metrics`, `eigenvalues`, `slopes` and `stable`.

    Raises:
        GaitsimError: The spec has no section to return to, or no periodic gait is found.
    """
    from gaitsim.study.cycles import cycle as found

    log = Logged()
    return found(opening(path, set, library, start, trust, candidate, results), mode, log, log.progress(""))


@dataclass(frozen=True)
class Search:
    """A search that ended: its folder and model (`tuning`), where it stands (`progress`), and what was adopted."""

    tuning: Tuning
    progress: Progress
    adoption: Adoption | None
    wall_seconds: float

    def __repr__(self) -> str:
        progress = self.progress
        score = "none" if self.score is None else f"{self.score:.6g}"
        return f"<Search: best score {score} after {progress.evaluations} evaluations; {self.folder}>"

    @property
    def folder(self) -> Path:
        """The result folder, for `gaitsim.load`."""
        return self.tuning.folder

    @property
    def score(self) -> float | None:
        """The best candidate's cost."""
        return self.progress.best.verdict.score if self.progress.best else None

    @property
    def values(self) -> dict[str, float]:
        """The best candidate's tuned values by address, in the units of `gaitsim.load(folder).parameters()`."""
        best = self.progress.best
        pairs = zip(self.tuning.problem.variables, best.candidate.x, strict=True) if best else ()
        return {variable.address: variable.unit.of(x) for variable, x in pairs}


def optimize(
    path: File,
    set: Settings | None = None,
    *,
    algorithm: str | None = None,
    population: int | None = None,
    generations: int | None = None,
    seed: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    scheduler_file: File | None = None,
    mode: Mode | None = None,
    smoke: bool = False,
    resume: bool = False,
    origin: str | None = None,
    adopt: bool = False,
    force: bool = False,
    results: File | None = None,
    trust: bool = False,
    library: Sequence[File] = (),
) -> Search:
    """Tune a spec. Every evaluation is kept; an interrupted search goes on with `resume=True`.

    Args:
        path: A spec; with `resume` also a result folder.
        set: Values by address.
        algorithm: Of the search; None leaves this, as the next three, to the spec.
        population: Candidates a generation.
        generations: At most.
        seed: The same seed searches the same.
        workers: Processes of this machine; 0 for this one, None for all cores.
        scheduler: A Dask scheduler to use instead, such as "tcp://127.0.0.1:8786".
        scheduler_file: A file that it wrote.
        mode: rapid or normal.
        smoke: Two generations of four.
        resume: Continue the newest search of this spec.
        origin: As `--from`: tuned, middle, or a result to start at.
        adopt: Write the best values beside the spec.
        force: With `adopt`: also over values that score better.
        results: Where result folders go, and names are looked up; None for $GAITSIM_RESULTS, or else results.
        trust: Run components of a result that this machine does not know.
        library: More folders of components.

    Returns:
        The search: `folder`, `score`, `values`, `progress`.

    Raises:
        GaitsimError: The spec or an argument is wrong, every candidate failed, or a cluster cannot be reached.
    """
    from gaitsim.study.adoption import adopted
    from gaitsim.study.searches import Request, begun, check_adoption, resumed
    from gaitsim.study.workplace import Workplace

    opened = replace(opening(path, set, library, trust=trust, results=results), tuned=False)
    check_adoption(opened, adopt, force)
    request = Request(opened, algorithm, population, generations, seed, mode, smoke, origin)
    file = None if scheduler_file is None else Path(scheduler_file)
    workplace = Workplace(workers, scheduler is not None or file is not None, scheduler, file)
    workplace.check()
    tuning = (resumed if resume else begun)(request, _root(results))
    began, log = time.perf_counter(), Logged()
    progress = tuning.run(workplace, lambda progress: None, log.say)
    wall = time.perf_counter() - began
    adoption = adopted(tuning, request, workplace, progress, force) if adopt else None
    return Search(tuning, progress, adoption, wall)


def analyze(
    *paths: File,
    set: Settings | None = None,
    candidate: str | Sequence[str] = (),
    start: bool = False,
    trust: bool = False,
    library: Sequence[File] = (),
    **wanted: Any,
) -> Analysis:
    """Run results or specs once more with every signal, and draw, film and write what is wanted of them.

    Args:
        paths: Result folders, or specs; several are drawn over each other.
        set: Values by address.
        candidate: Of each result: one, or several.
        start: Ignore tuned values beside a spec.
        trust: Run components of a result that this machine does not know.
        library: More folders of components.
        wanted: What is made, as `gaitsim.study.analyses.Wanted` has it: `plot=("*.force",)`, `export=("sto",)`,
            `only=True` for nothing else, `folder`.

    Returns:
        `replays` with every signal, and `products` with the files made; what could not be is in `products.faults`.

    Raises:
        GaitsimError: Nothing can be looked at, or nothing can be written.
        TypeError: A word of `wanted` is not known.
    """
    from gaitsim.study.analyses import Wanted, analyzed

    many = {name: _several(value) for name, value in wanted.items() if name in _MANY}
    folder = {"folder": Path(wanted["folder"])} if wanted.get("folder") is not None else {}
    opened = [opening(path, set, library, start, trust) for path in paths]
    return analyzed(opened, _several(candidate), Wanted(**(wanted | many | folder)), Logged())


def check(
    path: File,
    set: Settings | None = None,
    *,
    convergence: bool = False,
    trust: bool = False,
    library: Sequence[File] = (),
) -> Soundness:
    """Check a spec: grammar, units, wiring, components, mechanics, start.

    Args:
        path: A spec, or a result folder.
        set: Values by address.
        convergence: Also run it at its step, a half and a quarter.
        trust: Run components of a result that this machine does not know.
        library: More folders of components.

    Returns:
        What was found of a valid spec: `models`, `doubts`, `arms`, `convergence`.

    Raises:
        GaitsimError: With every fault, if it is not valid.
    """
    from gaitsim.study.soundness import checked

    return checked(opening(path, set, library, start=not convergence, trust=trust), convergence, Logged())


_MANY = ("plot", "return_map", "export", "scopes", "formats")


def _root(results: File | None) -> Path:
    """Where result folders go."""
    return results_folder(None if results is None else Path(results))


def _text(value: Any) -> str:
    """A value as a spec writes it."""
    if isinstance(value, str):
        return value
    return json.dumps(value, default=float, ensure_ascii=False)


def ranges(vary: Mapping[str, str | Sequence[Any]] | None) -> list[str]:
    """What is varied, each as ADDRESS=VALUES."""
    return [f"{address}={_values(values)}" for address, values in (vary or {}).items()]


def _several(words: str | Sequence[str]) -> tuple[str, ...]:
    return (words,) if isinstance(words, str) else tuple(words)


def _values(values: str | Sequence[Any]) -> str:
    return values if isinstance(values, str) else ",".join(map(_text, values))
