"""What a command is about: a spec with its tuned values, or a result with one of its candidates."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gaitsim.spec.study import Variant
    from gaitsim.study.source import Source


def source_of_spec(spec: Path, settings: list[str] | None, folders: list[Path] | None, tuned: bool) -> Source:
    """A spec, started at its tuned values if there are some and they are wanted.

    A variant without its own starts at those of the nearest parent that has some, if it tunes the same numbers,
    or fewer, from the same starts within the same bounds.
    """
    from gaitsim.cli.options import open_library, read_document
    from gaitsim.results.tuned import read_tuned, tuned_path
    from gaitsim.spec.inheritance import parents
    from gaitsim.study.source import Source

    source = Source(read_document(spec, settings), open_library(spec, folders), spec.stem, {})
    owner = next((path for path in (spec, *parents(spec)) if tuned_path(path).is_file()), None) if tuned else None
    if owner is None or not (owner == spec or _tunes_what(source, owner, folders)):
        return source
    path = tuned_path(owner)
    free = source.model().free
    tuned_there = read_tuned(path, free)
    notice = f"tuned values from {path} ({tuned_there.result}); --start ignores them"
    unused = [address for address in tuned_there.values if address not in {each.address for each in free}]
    if unused and owner == spec:
        notice += f"; not tuned here, so without effect: {', '.join(unused)}"
    return replace(source, starts=tuned_there.values, origin=str(path), notices=(notice,))


def _tunes_what(source: Source, parent: Path, folders: list[Path] | None) -> bool:
    """Whether all that a source tunes is tuned alike in the spec that it extends."""
    from gaitsim.cli.options import read_model

    alike = {(f.address, f.low, f.high, f.start) for f in read_model(parent, None, folders).free}
    return alike >= {(f.address, f.low, f.high, f.start) for f in source.model().free}


def started_from(source: Source, spec: Path, origin: str | None, trusted: bool) -> tuple[Source, list[str]]:
    """The source of a spec started where `--from` says, and what matched. Errors: Usage, BadResult, Untrusted."""
    from gaitsim.errors import Usage
    from gaitsim.results.manifest import is_result
    from gaitsim.results.tuned import read_tuned, tuned_path

    if origin is None:
        return source, []
    free = source.model().free
    if origin == "middle":
        where, values = "the middle of all bounds", {f.address: 0.5 * (f.low + f.high) for f in free}
    elif origin == "tuned":
        path = tuned_path(spec)
        if not path.is_file():
            raise Usage(f"--from tuned: there is no {path}; make it with optimize --adopt.")
        where, values = str(path), read_tuned(path, free).values
    else:
        where = origin
        if not is_result(Path(where)):
            raise Usage(f"--from {where}: this is no result; write tuned, middle, or a folder of gaitsim results list.")
        values = dict(open_source(Path(where), None, None, trusted=trusted).starts)
    addresses = [f.address for f in free]
    matched = [a for a in addresses if a in values]
    if not matched:
        known = ", ".join(values) or "nothing"
        raise Usage(f"--from {origin}: none of its values ({known}) is tuned here.")
    rest = [a for a in addresses if a not in values]
    notice = f"start from {where}: {', '.join(matched)}" + (f"; not found there: {', '.join(rest)}" if rest else "")
    return replace(source, starts={a: values[a] for a in matched}, origin=where), [notice]


def only_row(source: Source, path: Path) -> Variant:
    """The one run of a source that is no study. Errors: Usage."""
    from gaitsim.errors import Usage
    from gaitsim.spec.study import variants

    rows = variants(source.document, [])
    if len(rows) > 1:
        raise Usage(f"{path} is a study of {len(rows)} runs; take one with --candidate, or drop it: --set study=null.")
    return rows[0]


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
    from gaitsim.study.source import source_of_result

    if is_result(path):
        return source_of_result(path, settings or [], trusted, candidate)
    if candidate is not None:
        raise Usage(f"--candidate {candidate}: {path} is a spec; candidates belong to results.")
    return source_of_spec(path, settings, folders, tuned)
