"""The beginning of searches: from a spec in a new result folder, or at the end of an interrupted one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from shlex import quote
from typing import Any

from gaitsim.cluster.episodes import episode_models
from gaitsim.errors import Fault, InvalidSpec, Mark, Usage, command, did_you_mean
from gaitsim.optimization.algorithms import ALGORITHMS
from gaitsim.optimization.journal import old_form_notices, read
from gaitsim.results.bundle import SPEC, START, Bundle
from gaitsim.results.manifest import (
    BadResult,
    changed_versions,
    new_manifest,
    read_result,
    recorded_manifest,
)
from gaitsim.results.provenance import changes_file
from gaitsim.results.store import create_result
from gaitsim.results.trust import check_trust
from gaitsim.results.tuned import problem_of
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.schema import SearchSection, optimize_section
from gaitsim.study.opened import Opened
from gaitsim.study.opening import Opening, started_from
from gaitsim.study.starts import Starts
from gaitsim.study.tuning import Tuning
from gaitsim.whole import PARTIAL

_SMOKE = {"population": 4, "generations": 2}
_MOVE = "make room or rights there, or name another folder with --results"
_LEAST = {"population": 2, "generations": 1, "seed": 0}


@dataclass(frozen=True)
class Request:
    """A request for a search. None leaves a setting to the spec.

    Attributes:
        opening: Without tuned values, because a search starts at the numbers of the spec.
        origin: The start, as for `started_from`.
    """

    opening: Opening
    algorithm: str | None = None
    population: int | None = None
    generations: int | None = None
    seed: int | None = None
    mode: str | None = None
    smoke: bool = False
    origin: str | None = None

    @property
    def arguments(self) -> list[str]:
        """The options that --resume needs again: settings and libraries."""
        settings = [word for text in self.opening.settings for word in ("--set", text)]
        return [*settings, *(word for folder in self.opening.folders for word in ("--library", str(folder)))]


def check_adoption(opening: Opening, adopt: bool, force: bool) -> None:
    """Check that the result of a search can be adopted.

    Raises:
        Usage: An adoption that cannot be.
    """
    if force and not adopt:
        raise Usage("--force needs --adopt: it replaces better values; add --adopt, or leave it out.")
    if adopt and opening.names_result:
        raise Usage(f"--adopt writes beside a spec, and {opening.path} is a result; name the spec, with --resume.")


def started(request: Request, root: Path) -> Tuning:
    """Begin a search in a new result folder."""
    path = request.opening.path
    if request.opening.names_result:
        move = f"{command('optimize', path, '--resume')}, or SPEC --from {quote(str(path))}"
        raise Usage(f"{path} is a result; to continue or to start from it: {move}")
    opened = request.opening.open()
    opened, notices = started_from(opened, request.opening, request.origin)
    model = opened.model()
    if not model.free:
        rule = "nothing is tuned in this spec"
        move = "give a value bounds, such as gain: {value: 1, tune: [0, 5]}"
        raise InvalidSpec(Fault(f"{rule}; {move}.", Mark(str(request.opening.path))))
    if model.objective is None:
        move = "add one, such as objective: {use: objective/maximize, value: {from: a metric}}"
        raise InvalidSpec(Fault(f"this spec has no objective; {move}.", Mark(str(request.opening.path))))
    search = _search_of(opened, request)
    problem = problem_of(model, search["spread_factor"])
    algorithm = ALGORITHMS[search["algorithm"]].make(problem, search["seed"], search["population"])
    search["population"] = algorithm.population
    mode: Mode = "normal" if request.mode == "normal" else "rapid"
    each = episode_models(opened.document, opened.library, opened.name)
    simulator, starts = Simulator(model, mode), Starts(opened)
    for one in (simulator, *(Simulator(episode.started_at(opened.starts), mode) for episode in each)):
        starts.look_at(one)
    bundle = opened.bundle([model, *each])
    fields = {"spec": str(request.opening.path), "search": search, "smoke": request.smoke, "notices": notices}
    manifest = new_manifest("optimize", bundle, mode, opened.place, **fields)
    more = {"evaluations.jsonl": "", **changes_file(opened.place)}
    folder = create_result(root, bundle, model, simulator.xml, manifest, more, _MOVE)
    bundle = replace(bundle, folder=folder)
    return Tuning(folder, manifest, bundle, model, [*model.notices, *starts.warnings, *notices])


def resumed(request: Request, root: Path) -> Tuning:
    """Open an interrupted search: the given folder, or the newest search of the spec.

    Raises:
        BadResult: The folder is not a result, or the result is damaged.
        DamagedJournal: The journal is damaged.
        Usage: The request does not fit.
        InvalidSpec: The spec has changed.
    """
    _check_beside_resume(request)
    folder = request.opening.path if request.opening.names_result else _newest(request.opening.path, root)
    manifest, bundle = read_result(folder)
    if manifest["kind"] != "optimize":
        raise BadResult(f"{folder}: this is the result of a run; only a search can be resumed.")
    search = _recorded_search(folder, manifest)
    changed = changed_versions(manifest)
    if changed:
        rule = f"it was made with other versions ({', '.join(changed)}), so it would not continue identically"
        raise BadResult(f"{folder}: {rule}; install those, or start a new search with --from {folder}.")
    check_trust(bundle, request.opening.trusted)
    _check_links(folder)
    if not request.opening.names_result:
        _check_same_spec(request, folder, bundle)
    _check_same_search(request, search, str(manifest["mode"]))
    done = max((e.candidate.generation for e in read(folder)), default=0)
    if request.generations is not None and request.generations < done:
        raise Usage(f"--generations {request.generations}: {folder} has {done} generations already; ask for more.")
    search["generations"] = request.generations or search["generations"]
    notices = [f"resuming {folder}", *old_form_notices(folder)]
    return Tuning(folder, manifest | {"search": search}, bundle, bundle.model(), notices)


def _check_links(folder: Path) -> None:
    """Check that no file of the result is a link, so that a search writes into its own folder only."""
    links = sorted(path for path in folder.iterdir() if path.is_symlink())
    if links:
        rule = "this is a link, and a search that goes on would write to what it leads to"
        raise BadResult(f"{links[0]}: {rule}; put the file itself in its place.")


def _check_beside_resume(request: Request) -> None:
    """Refuse options that cannot be changed when a search continues."""
    if request.origin is not None or request.smoke:
        option = "--smoke" if request.smoke else "--from"
        raise Usage(f"{option} begins a new search, and --resume continues an old one; leave one out.")
    if request.opening.names_result and (request.opening.settings or request.opening.folders):
        option = "--set" if request.opening.settings else "--library"
        raise Usage(f"{option}: {request.opening.path} goes on with its own spec and components; leave it out.")
    _check_least({"generations": request.generations})


def _check_same_search(request: Request, search: dict[str, Any], mode: str) -> None:
    """Check that a search continues as it began; only the number of generations may change."""
    for name in ("algorithm", "population", "seed"):
        asked = getattr(request, name)
        if asked is not None and asked != search[name]:
            move = "leave it out, or start a new search"
            raise Usage(f"--{name} {asked}: this search was started with {search[name]}; {move}.")
    if request.mode is not None and request.mode != mode:
        raise Usage(f"--mode {request.mode}: this search was started in {mode} mode; leave it out.")


def _recorded_search(folder: Path, manifest: dict[str, Any]) -> dict[str, Any]:
    """The settings of the search in a manifest."""
    try:
        found = SearchSection.model_validate(manifest["search"]).model_dump()
        if found["algorithm"] not in ALGORITHMS or not isinstance(manifest["versions"], dict):
            raise ValueError("no search of ours")
        return found
    except (KeyError, ValueError) as error:
        rule = "what it says about its search cannot be read, so it was edited; restore it from a copy"
        raise BadResult(Fault(f"{rule}.", Mark(str(folder / "manifest.json")))) from error


def _check_least(numbers: Mapping[str, int | None]) -> None:
    """Check that numbers of the request are large enough.

    Raises:
        Usage: A number that is too small.
    """
    for name, number in numbers.items():
        if number is not None and number < _LEAST[name]:
            raise Usage(f"--{name} {number}: the smallest value is {_LEAST[name]}.")


def _search_of(opened: Opened, request: Request) -> dict[str, Any]:
    """Algorithm, population, generations and seed: options of the command line, else of the spec, else defaults."""
    section = optimize_section(opened.document)
    asked = {n: getattr(request, n) for n in ("algorithm", "population", "generations", "seed")}
    smoke = _SMOKE if request.smoke else {}
    settings = section.model_dump(include={*SearchSection.model_fields})
    found = settings | smoke | {name: value for name, value in asked.items() if value is not None}
    if found["algorithm"] not in ALGORITHMS:
        hint = did_you_mean(found["algorithm"], ALGORITHMS)
        raise Usage(f"--algorithm {found['algorithm']}: there is no such algorithm. {hint}")
    _check_least({name: found[name] for name in _LEAST})
    return found


def _newest(spec: Path, root: Path) -> Path:
    """The newest search of a spec, except trials. Damage is noticed when it is read."""
    found: list[tuple[str, float, Path]] = []
    trials: list[tuple[str, float, Path]] = []
    for path in root.glob(f"*-{spec.stem}-*/manifest.json"):
        try:
            manifest = recorded_manifest(path.parent)
            if manifest["kind"] == "optimize" and manifest["name"] == spec.stem and path.parent.suffix != PARTIAL:
                place = (manifest["created"], path.stat().st_mtime, path.parent)
                (trials if manifest.get("smoke") else found).append(place)
        except (OSError, BadResult):
            continue
    if found:
        return max(found)[2]
    rule = f"{root}: there is no search of {spec} to resume"
    if trials:
        move = f"name it to continue it: {command('optimize', max(trials)[2], '--resume')}"
        raise BadResult(f"{rule} but one by --smoke; {move}")
    raise BadResult(f"{rule}; start one without --resume.")


def _check_same_spec(request: Request, folder: Path, bundle: Bundle) -> None:
    """Check that the spec is the one with which the search began."""
    opened = request.opening.open()
    models = [opened.model(), *episode_models(opened.document, opened.library, opened.name)]
    now = opened.bundle(models).files
    before = {path: text for path, text in bundle.files.items() if path != START}
    changed = sorted(path for path in {*now, *before} if now.get(path) != before.get(path))
    if changed:
        files = ["spec.yaml (or its --set)" if path == SPEC else path for path in changed]
        rule = f"what {folder} was started with has changed since: {', '.join(files)}"
        old = command("optimize", folder, "--resume")
        move = f"continue the old one: {old}; or start a new search with --from {quote(str(folder))}"
        raise InvalidSpec(Fault(f"{rule}; {move}.", Mark(str(request.opening.path))))
