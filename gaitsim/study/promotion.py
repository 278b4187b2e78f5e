"""Promotion of a component from a project to a library. It needs documentation, sources, bounds, and a test of its
physics.
"""

from __future__ import annotations

import ast
import importlib.util
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from gaitsim.components.bibliography import FILE, keys_of, read_bibliography
from gaitsim.components.checks.shared import imported_names
from gaitsim.components.composite import ComponentFile
from gaitsim.components.find import KIND, Library, display_path, library_folders
from gaitsim.components.places import lab_of, project_of
from gaitsim.components.review import review
from gaitsim.components.skeleton import test_of
from gaitsim.distribution import shipped_folder
from gaitsim.errors import Fault, GaitsimError, InvalidComponent, Mark, SimulationFailed, Usage
from gaitsim.results.store import CannotSave
from gaitsim.study.acceptance import Effect, tested
from gaitsim.study.listening import Listener
from gaitsim.study.uses import Scope
from gaitsim.whole import write_whole

_BESIDE = 'Path(__file__).parents[1] / "components"'  # how tests of `library new` find their component
_WRITTEN = frozenset(
    node.name for node in ast.walk(ast.parse(test_of("kind", "name"))) if isinstance(node, ast.FunctionDef)
)
_LINES = 25  # of a test that fails


@dataclass(frozen=True)
class Request:
    """A request for a promotion.

    Attributes:
        origin: The folder of kinds with the component.
        target: The library.
        test: The file of the test.
        replace: Whether to replace a component of the same name, if none of its users changes.
        force: Whether to replace it even if users change.
        scope: Where users are searched for.
    """

    reference: str
    origin: Path
    target: Path
    test: Path
    replace: bool
    force: bool
    scope: Scope


@dataclass(frozen=True)
class Promoted:
    """What was done: new files of the library, removed files of the project, and the results of the users of a
    replaced component.
    """

    files: tuple[Path, ...]
    removed: tuple[Path, ...]
    users: tuple[Effect, ...]


class Changes(GaitsimError):
    """The users of a component would give other results with its new version."""

    exit_code = SimulationFailed.exit_code

    def __init__(self, message: str, users: tuple[Effect, ...]) -> None:
        super().__init__(message)
        self.users = users


def asked(
    reference: str,
    origin: Path | None,
    target: Path | None,
    test: Path | None,
    replace: bool,
    force: bool,
    scope: Scope,
) -> Request:
    """Make the request from options. By default the component moves from this project to the library of its lab.

    Raises:
        Usage: There is no such component, or no library.
    """
    here = origin or project_of(Path.cwd()) or Path()
    folder = here / "components" if (here / "components").is_dir() else here
    kind, _, name = reference.partition("/")
    if not any((folder / kind / f"{name}{suffix}").is_file() for suffix in (".py", ".yaml")):
        found = Library((folder,)) if folder.is_dir() else Library(())
        hint = f"Here are: {', '.join(found.references())}." if found.references() else "Name its project with --from."
        raise Usage(f"{reference}: {display_path(folder)} has no such component. {hint}")
    lab = lab_of(folder)
    if target is None and lab is None:
        raise Usage("there is no lab here, whose library it could go to; name a library: --to FOLDER.")
    to = target or (lab / "library" if lab else Path())
    if to.resolve() == folder.resolve():
        raise Usage(f"--to {to}: the component exists already; name another library.")
    return Request(reference, folder, to, test or folder.parent / "tests" / f"test_{name}.py", replace, force, scope)


def promoted(request: Request, listener: Listener) -> Promoted:
    """Check a component, run its test in a copy of the library, and move both. Nothing is changed before all checks
    pass.

    Raises:
        Usage: Something exists already.
        InvalidComponent: Docs, sources, bounds or the test are lacking, or the test fails.
        Changes: Users of the version that is there would change.
        CannotSave: The library cannot be written.
    """
    component = _reviewed(request)
    test = _physics_test(request)
    files = _files(request, component, test)
    taken = _taken(request, files)
    with tempfile.TemporaryDirectory(prefix="gaitsim-") as folder:
        stage = Path(folder) / request.target.name
        _stage(stage, request, files)
        with listener.waiting("its test"):
            _run_test(stage.parent / "tests" / "library" / request.test.name, request.test)
        users = _users(request, stage, listener) if taken else ()
    wrong = [user for user in users if user.state in ("differs", "error")]
    if wrong and not request.force:
        names = ", ".join(user.name for user in wrong)
        rule = f"{request.reference}: {len(wrong)} of its users would not do what was recorded: {names}"
        raise Changes(f"{rule}. If this is meant, use --force, and then gaitsim archive record.", tuple(users))
    _write(request, files)
    return Promoted(tuple(files), _removed(request, component), tuple(users))


def _reviewed(request: Request) -> ComponentFile:
    """The component, after the checks of a library.

    Raises:
        InvalidComponent: A component file breaks the contract.
    """
    library = Library((request.origin, *_behind(request.target)))
    faults = review(request.reference, library)
    if faults:
        raise InvalidComponent(faults)
    component = library.find(request.reference)
    inside = [r for r, c in library.used().items() if c is not component and c.path.parents[1] == request.origin]
    if inside:
        rule = f"it has inner parts of the project: {', '.join(inside)}; promote these first."
        raise InvalidComponent(Fault(rule, Mark(display_path(component.path))))
    return component


def _behind(target: Path) -> tuple[Path, ...]:
    """The library and the shipped one."""
    return (target, *([] if target.resolve() == shipped_folder().resolve() else [shipped_folder()]))


def _physics_test(request: Request) -> str:
    """The text of the test, adapted to the library."""
    path, name = request.test, request.reference
    place = Mark(display_path(path))
    form = "gaitsim library new writes the beginning of one"
    if not path.is_file():
        raise InvalidComponent(
            Fault(f"there is no test of {name}; write it here, or name it: --test FILE. {form}.", place)
        )
    text = path.read_text(encoding="utf-8")
    try:
        tree = ast.parse(text)
    except SyntaxError as error:
        raise InvalidComponent(
            Fault(f"this is no Python: {error.msg}.", Mark(display_path(path), error.lineno or 0))
        ) from error
    if name not in text:
        raise InvalidComponent(Fault(f"this test does not name {name}; name the test of it: --test FILE.", place))
    modules = {node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    modules |= {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    if not any(module == "gaitsim" or module.startswith("gaitsim.simulation") for module in modules):
        rule = (
            "this test calls nothing: it imports neither gaitsim.simulation.trial, for the component alone, nor gaitsim"
        )
        raise InvalidComponent(Fault(f"{rule}, for a model with it.", place))
    own = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")]
    if not any(
        node.name not in _WRITTEN and any(isinstance(n, ast.Assert | ast.Call) for n in ast.walk(node)) for node in own
    ):
        rule = "these are only the tests that gaitsim library new writes; add one of the physics"
        raise InvalidComponent(Fault(f"{rule}, such as a force that the paper has for a length.", place))
    return text.replace(_BESIDE, f'Path(__file__).parents[2] / "{request.target.resolve().name}"')


def _files(request: Request, component: ComponentFile, test: str) -> dict[Path, str]:
    """The files that the library gets: the component, its test, and missing files of its kind and its sources."""
    kind, target = component.kind, request.target
    files = {target / kind / component.path.name: component.path.read_text(encoding="utf-8")}
    files[target.resolve().parent / "tests" / "library" / request.test.name] = test
    if Library(_behind(target)).contract(kind) is None:
        files[target / kind / KIND] = (request.origin / kind / KIND).read_text(encoding="utf-8")
    for name in imported_names(component.text) if component.path.suffix == ".py" else ():
        own = request.origin / kind / f"{name}.py"
        if own.is_file():
            files[target / kind / own.name] = own.read_text(encoding="utf-8")
    cited = {key for one in component.parameters.values() for key in keys_of(one.source)}
    lacking = cited - set(read_bibliography(_behind(target)))
    if lacking:
        mine, there = read_bibliography((request.origin,)), target / FILE
        before = there.read_text(encoding="utf-8").rstrip() + "\n\n" if there.is_file() else ""
        files[there] = before + "\n\n".join(mine[key] for key in sorted(lacking)) + "\n"
    return files


def _taken(request: Request, files: Mapping[Path, str]) -> bool:
    """Whether the library has a component of this name."""
    known = Library(_behind(request.target)).file(request.reference)
    for path, text in files.items():
        other = path.is_file() and path.name != FILE and path.read_text(encoding="utf-8") != text
        if other and not request.replace:
            rule = "this exists already and is overwritten only with --replace"
            raise Usage(f"{display_path(path)}: {rule}; choose another name, or add it.")
    if known is not None and not request.replace:
        rule = f"{request.reference} exists already ({display_path(known)})"
        raise Usage(f"{rule}; choose another name, or use --replace, which runs all its users first.")
    return known is not None


def _stage(stage: Path, request: Request, files: Mapping[Path, str]) -> None:
    """Copy the library and its tests, and add the new files."""
    if request.target.is_dir():
        shutil.copytree(request.target, stage, ignore=shutil.ignore_patterns("__pycache__"))
    for path, text in files.items():
        inner = path.relative_to(request.target) if path.is_relative_to(request.target) else None
        place = stage / inner if inner else stage.parent / "tests" / "library" / path.name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text, encoding="utf-8")


def _run_test(staged: Path, own: Path) -> None:
    """Run the test of the component with pytest.

    Raises:
        InvalidComponent: The test fails.
        Usage: Without pytest.
    """
    if importlib.util.find_spec("pytest") is None:
        raise Usage("promoting a component runs its test with pytest, which is not installed: pip install pytest")
    requirements = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        "--rootdir",
        str(staged.parent),
        str(staged),
    ]
    ran = subprocess.run(requirements, cwd=staged.parent, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if ran.returncode:
        output = "\n".join(f"{ran.stdout}\n{ran.stderr}".strip().splitlines()[-_LINES:])
        rule = "this test does not pass beside the library, so nothing was promoted; correct it, or the component"
        raise InvalidComponent(Fault(f"{rule}:\n{output}", Mark(display_path(own))))


def _users(request: Request, stage: Path, listener: Listener) -> tuple[Effect, ...]:
    """The results of the users of the present component with the new version."""
    scope = Scope(request.scope.names, request.scope.results, (stage, *request.scope.folders))
    return tuple(tested(request.reference, scope, False, listener))


def _write(request: Request, files: Mapping[Path, str]) -> None:
    """Write all files, or none."""
    before = {path: path.read_text(encoding="utf-8") if path.is_file() else None for path in files}
    done: list[Path] = []
    try:
        for path, text in files.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(path, text)
            done.append(path)
    except OSError as error:
        for path in done:
            old = before[path]
            path.unlink() if old is None else write_whole(path, old)
        rule = f"the library cannot be written ({error.strerror or error})"
        raise CannotSave(f"{request.target}: {rule}; nothing was changed. Make room or rights there.") from error


def _removed(request: Request, component: ComponentFile) -> tuple[Path, ...]:
    """Remove the files of the project that are now in the library. They stay if specs of the project do not use that
    library.
    """
    seen = {folder.resolve() for folder in library_folders(request.origin.parent / "spec.yaml")}
    if request.target.resolve() not in seen:
        return ()
    for path in (component.path, request.test):
        path.unlink()
    return component.path, request.test
