"""What a command is about: a spec with its tuned values, or a result with one of its candidates."""

from __future__ import annotations

from collections.abc import Iterable
from collections.abc import Mapping as Map
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gaitsim.model import Model
    from gaitsim.parts.find import Library
    from gaitsim.results.bundle import Bundle
    from gaitsim.spec.document import Mapping


@dataclass(frozen=True)
class Source:
    """A document, the components it may use, and where its tuned numbers start."""

    document: Mapping
    library: Library
    name: str
    starts: Map[str, float]
    notices: tuple[str, ...] = ()
    manifest: Map[str, Any] = field(default_factory=dict)

    def model(self, document: Mapping | None = None) -> Model:
        """The model of the document, or of a variant of it."""
        from gaitsim.spec.resolve import resolve

        return resolve(document or self.document, self.library, self.name).started_at(self.starts)

    def bundle(self, models: Iterable[Model]) -> Bundle:
        """The source as files, given the models made of it."""
        from gaitsim.results.bundle import bundled

        return bundled(self.document, self.name, self.library, self.starts, models)


def source_of_spec(spec: Path, settings: list[str] | None, folders: list[Path] | None, tuned: bool) -> Source:
    """A spec, started at its tuned values if there are some and they are wanted."""
    from gaitsim.cli.options import open_library, read_document
    from gaitsim.results.tuned import read_tuned, tuned_path

    document, library = read_document(spec, settings), open_library(spec, folders)
    beside = tuned_path(spec)
    if not (tuned and beside.is_file()):
        return Source(document, library, spec.stem, {})
    result, values = read_tuned(beside)
    notice = f"tuned values from {beside} ({result}); --start ignores them"
    return Source(document, library, spec.stem, values, (notice,))


def source_of_result(folder: Path, settings: list[str] | None, trusted: bool, candidate: str | None) -> Source:
    """A result's own spec and components, started at one of its candidates."""
    from gaitsim.results.bundle import bundle_document, bundle_library, bundle_model, bundle_starts
    from gaitsim.results.manifest import read_manifest
    from gaitsim.results.pick import pick
    from gaitsim.results.trust import check_trust
    from gaitsim.spec.inheritance import override, split_setting

    manifest = read_manifest(folder)
    check_trust(folder, trusted)
    document, library, name = bundle_document(folder), bundle_library(folder), str(manifest["name"])
    starts = bundle_starts(folder)
    notices: tuple[str, ...] = ()
    if manifest["kind"] == "optimize":
        evaluation = pick(folder, candidate or "best")
        place = evaluation.candidate
        starts = dict(zip((f.address for f in bundle_model(folder, name).free), place.x, strict=True))
        notices = (f"candidate {place.generation}:{place.index} of {folder}",)
    for setting in settings or []:
        document = override(document, *split_setting(setting))
    return Source(document, library, name, starts, notices, manifest)


def open_source(
    path: Path,
    settings: list[str] | None,
    folders: list[Path] | None,
    tuned: bool = True,
    trusted: bool = False,
    candidate: str | None = None,
) -> Source:
    """The source that a path names: a spec, or a result folder.

    Errors: InvalidSpec, BadResult, Untrusted, Usage.
    """
    from gaitsim.errors import Usage
    from gaitsim.results.manifest import is_result

    if is_result(path):
        return source_of_result(path, settings, trusted, candidate)
    if candidate is not None:
        raise Usage(f"--candidate {candidate}: {path} is a spec; candidates belong to results.")
    return source_of_spec(path, settings, folders, tuned)
