"""What a command is about: a spec with its tuned values, or a result with one of its candidates."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gaitsim.results.source import Source


def source_of_spec(spec: Path, settings: list[str] | None, folders: list[Path] | None, tuned: bool) -> Source:
    """A spec, started at its tuned values if there are some and they are wanted."""
    from gaitsim.cli.options import open_library, read_document
    from gaitsim.results.source import Source
    from gaitsim.results.tuned import read_tuned, tuned_path

    document, library = read_document(spec, settings), open_library(spec, folders)
    beside = tuned_path(spec)
    if not (tuned and beside.is_file()):
        return Source(document, library, spec.stem, {})
    result, values = read_tuned(beside)
    notice = f"tuned values from {beside} ({result}); --start ignores them"
    return Source(document, library, spec.stem, values, (notice,))


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
    from gaitsim.results.source import source_of_result

    if is_result(path):
        return source_of_result(path, settings or [], trusted, candidate)
    if candidate is not None:
        raise Usage(f"--candidate {candidate}: {path} is a spec; candidates belong to results.")
    return source_of_spec(path, settings, folders, tuned)
