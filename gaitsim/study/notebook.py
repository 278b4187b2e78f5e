"""The functions for notebooks. Each does what the command of its name does, and returns what the command prints.

Keywords have the names of options, and errors refer to these. Warnings are logged. Mistakes raise
`gaitsim.errors.GaitsimError`. A run that fails is not an error; its outcome has the reason.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.folders import results_folder
from gaitsim.study.listening import LogListener
from gaitsim.study.opening import Opening

if TYPE_CHECKING:
    from gaitsim.optimization.search import Progress
    from gaitsim.simulation.run import Mode
    from gaitsim.study.adoption import Adoption
    from gaitsim.study.analyses import Analysis
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
    """A spec or a result to open.

    Args:
        path: A spec, or a result folder.
        set: Values by address: `{"feedback.gain": 3, "simulate.duration": "2 s"}`.
        library: Folders of more components.
        start: Whether to ignore tuned values beside the spec.
        trust: Whether to run components of a result that this machine does not know.
        candidate: The candidate of a result: best, a rank, GENERATION:INDEX, or the number of a run.
        results: The folder in which names of results are looked up; None for the usual one.
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
    """Simulate a spec or a candidate of a result: once, for each row of a study, or for each draw.

    Args:
        path: A spec, or a result folder.
        set: Values by address: `{"feedback.gain": 3, "simulate.duration": "2 s"}`.
        vary: Values to run, by address: a list, or a range such as "1:15:8".
        draws: The number of runs with randomly changed tuned values.
        within: The largest relative change of the draws, such as "1 %".
        seed: The seed of the draws.
        mode: "rapid" (native code) or "normal" (plain Python).
        out: A CSV file for every signal of a single run, in SI.
        every: The time between two instants in `out`, such as "10 ms"; None for every step.
        save: Whether to save a result folder.
        results: The folder of results, in which names are looked up too; None for $GAITSIM_RESULTS, or else results.
        candidate: The candidate of a result: best, a rank, GENERATION:INDEX, or the number of a run.
        start: Whether to ignore tuned values beside the spec.
        trust: Whether to run components of a result that this machine does not know.
        library: Folders of more components.

    Returns:
        The runs: `outcomes` with status, metrics (in declared units) and score, `table()`, `folder`, `notices`. If
            something could not be
        saved, the reason is in `unsaved`. Warnings are logged.
    """
    from gaitsim.study.draws import draws_asked
    from gaitsim.study.runs import Places, prepared

    varied = ranges(vary)
    file = None if out is None else Path(out)
    samples = draws_asked(draws, within, seed, varied, file)
    opened = opening(path, set, library, start, trust, candidate, results)
    runs = prepared(opened, varied, samples, mode, Places(_root(results) if save else None, file, every), LogListener())
    runs.run(LogListener())
    if runs.unsaved:
        LogListener().say_error(runs.unsaved)
    return runs


@dataclass(frozen=True)
class Search:
    """A search that ended: its folder and model (`tuning`), its state (`progress`), and the outcome of adopting its
    values.
    """

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
        """The cost of the best candidate."""
        return self.progress.best.verdict.score if self.progress.best else None

    @property
    def values(self) -> dict[str, float]:
        """The tuned values of the best candidate by address, in the units of `gaitsim.load(folder).parameters()`."""
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
    """Tune a spec. Every evaluation is stored; `resume=True` continues an interrupted search.

    Args:
        path: A spec; with `resume` also a result folder.
        set: Values by address.
        algorithm: The search algorithm; None uses that of the spec, also for the next three.
        population: The number of candidates per generation.
        generations: The largest number of generations.
        seed: The seed of the search.
        workers: The number of processes; 0 uses this process, None all cores.
        scheduler: The address of a Dask scheduler to use instead, such as "tcp://127.0.0.1:8786".
        scheduler_file: A file written by the scheduler.
        mode: "rapid" or "normal".
        smoke: Whether to try two generations of four candidates only.
        resume: Whether to continue the newest search of this spec.
        origin: The start: tuned, middle, or a result, as for `--from`.
        adopt: Whether to write the best values beside the spec.
        force: With `adopt`: whether to replace even values that score better.
        results: The folder of results, in which names are looked up too; None for $GAITSIM_RESULTS, or else results.
        trust: Whether to run components of a result that this machine does not know.
        library: Folders of more components.

    Returns:
        The search: `folder`, `score`, `values`, `progress`.
    """
    from gaitsim.study.adoption import adopted
    from gaitsim.study.searches import Request, check_adoption, resumed, started
    from gaitsim.study.workplace import Workplace

    opened = replace(opening(path, set, library, trust=trust, results=results), tuned=False)
    check_adoption(opened, adopt, force)
    request = Request(opened, algorithm, population, generations, seed, mode, smoke, origin)
    file = None if scheduler_file is None else Path(scheduler_file)
    workplace = Workplace(workers, scheduler is not None or file is not None, scheduler, file)
    workplace.check()
    tuning = (resumed if resume else started)(request, _root(results))
    began, log = time.perf_counter(), LogListener()
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
    results: File | None = None,
    **wanted: Any,
) -> Analysis:
    """Run results or specs once more with every signal, and make figures, films and files.

    Args:
        paths: Result folders or specs; several are drawn over one another.
        set: Values by address.
        candidate: One or several candidates of each result.
        start: Whether to ignore tuned values beside a spec.
        trust: Whether to run components of a result that this machine does not know.
        library: Folders of more components.
        results: The folder in which names of results are looked up; what is made of specs goes to `analysis` in it.
        wanted: Fields of `gaitsim.study.analyses.AnalysisRequest`: `plot=("*.force",)`, `export=("sto",)`,
            `only=True` for nothing else, `folder`.

    Returns:
        `replays` with every signal, and `products` with the files; what could not be made is in `products.faults`.
    """
    from gaitsim.study.analyses import AnalysisRequest, analyzed

    many = {name: _several(value) for name, value in wanted.items() if name in _MANY}
    folder = {"folder": Path(wanted["folder"])} if wanted.get("folder") is not None else {}
    opened = [opening(path, set, library, start, trust, results=results) for path in paths]
    return analyzed(opened, _several(candidate), AnalysisRequest(**(wanted | many | folder)), LogListener())


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
        convergence: Whether to run it at its step, a half and a quarter too.
        trust: Whether to run components of a result that this machine does not know.
        library: Folders of more components.

    Returns:
        What was found in a valid spec: `models`, `warnings`, `arms`, `convergence`.
    """
    from gaitsim.study.soundness import checked

    return checked(opening(path, set, library, start=not convergence, trust=trust), convergence, LogListener())


_MANY = ("plot", "return_map", "export", "scopes", "formats")


def _root(results: File | None) -> Path:
    """The folder of results."""
    return results_folder(None if results is None else Path(results))


def _text(value: Any) -> str:
    """A value as text for a spec."""
    if isinstance(value, str):
        return value
    return json.dumps(value, default=float, ensure_ascii=False)


def ranges(vary: Mapping[str, str | Sequence[Any]] | None) -> list[str]:
    """Values by address, each as ADDRESS=VALUES."""
    return [f"{address}={_values(values)}" for address, values in (vary or {}).items()]


def _several(texts: str | Sequence[str]) -> tuple[str, ...]:
    return (texts,) if isinstance(texts, str) else tuple(texts)


def _values(values: str | Sequence[Any]) -> str:
    return values if isinstance(values, str) else ",".join(map(_text, values))
