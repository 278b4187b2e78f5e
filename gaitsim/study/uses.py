"""The users of a component: specs that resolve to it, and results that hold a copy of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from gaitsim.components.find import Library, display_path
from gaitsim.components.places import lab_of
from gaitsim.distribution import shipped_specs
from gaitsim.errors import GaitsimError, Usage
from gaitsim.results.bundle import Bundle
from gaitsim.results.manifest import read_result
from gaitsim.study.archive import Archived, archived
from gaitsim.study.listening import Listener
from gaitsim.study.records import SHORT
from gaitsim.text.document import parse
from gaitsim.whole import PARTIAL


@dataclass(frozen=True)
class UsingSpec:
    """A spec that uses a component, and the version that it gets."""

    archived: Archived
    version: str


@dataclass(frozen=True)
class UsingResult:
    """A result with a copy of a component: its folder, its date, and the version of the copy."""

    folder: Path
    created: str
    version: str
    bundle: Bundle
    kind: str
    mode: str


@dataclass(frozen=True)
class Scope:
    """Where users of components are searched for.

    Attributes:
        names: Specs and folders of specs; if empty, the shipped ones, those in this folder, and those of the lab's
            projects.
        results: Folders of results.
        folders: Folders of more components, which are searched before all others except those beside a spec.
    """

    names: tuple[str, ...]
    results: tuple[Path, ...]
    folders: tuple[Path, ...] = ()

    def library(self) -> Library:
        """The library in which components are looked up.

        Raises:
            Usage: The request does not fit.
        """
        from gaitsim.study.opening import open_library

        return open_library(None, self.folders)

    def version(self, reference: str) -> str:
        """The present version of a component.

        Raises:
            Usage: There is none of this name.
        """
        library = self.library()
        found = library.version(reference)
        if found is None:
            raise Usage(library.unknown(reference))
        return found

    def specs(self) -> list[Archived]:
        """All specs that are searched.

        Raises:
            Usage: The request does not fit.
        """
        if self.names:
            return archived(self.names, self.folders)
        lab, here = lab_of(Path.cwd()), Path()
        folders = [here, *(sorted((lab / "projects").glob("*/")) if lab else [])]
        own = [path for folder in folders for path in sorted(folder.glob("*.yaml")) if _is_spec(path)]
        known = {path.resolve() for path in shipped_specs().values()}
        mine = {path.resolve(): Archived(display_path(path), path, self.folders) for path in own}
        return [*archived((), self.folders), *(each for path, each in mine.items() if path not in known)]


def using_specs(reference: str, scope: Scope, listener: Listener) -> Iterator[UsingSpec]:
    """The specs that use a component or a table. A spec that cannot be resolved is reported to the listener.

    Raises:
        Usage: The request does not fit.
    """
    specs = scope.specs()
    report = listener.progress("specs read")
    for count, spec in enumerate(specs, start=1):
        try:
            version = spec.made_from().components.get(reference)
        except GaitsimError as error:
            listener.say_error(error)
            version = None
        report(count, len(specs))
        if version is not None:
            yield UsingSpec(spec, version)


def using_results(reference: str, scope: Scope, listener: Listener) -> Iterator[UsingResult]:
    """Find the results with a copy of a component or a table.

    Args:
        reference: The component, such as muscle/geyer2003.
        scope: Where results are searched for.
        listener: Receives the error of a damaged result.

    Yields:
        The results, oldest first.
    """
    found = []
    for manifest_file in [path for root in scope.results for path in sorted(root.glob("*/manifest.json"))]:
        folder = manifest_file.parent
        if folder.suffix == PARTIAL:
            continue
        try:
            manifest, bundle = read_result(folder)
            version = bundle.library().version(reference)
        except GaitsimError as error:
            listener.say_error(error)
            continue
        if version is not None:
            fields = [str(manifest[key]) for key in ("kind", "mode")]
            found.append(UsingResult(folder, str(manifest["created"]), version[:SHORT], bundle, *fields))
    yield from sorted(found, key=lambda each: (each.created, str(each.folder)))


def _is_spec(path: Path) -> bool:
    """Whether a YAML file is a spec, and not tuned values or something else."""
    try:
        return not path.stem.endswith(".tuned") and "gaitsim" in parse(path.read_text(encoding="utf-8"), "").entries
    except (OSError, UnicodeError, GaitsimError):
        return False
