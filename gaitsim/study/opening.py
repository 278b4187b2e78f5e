"""What to open, a spec or a result, and with which options."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gaitsim.components.find import Library
    from gaitsim.spec.study import Variant
    from gaitsim.study.opened import Opened
    from gaitsim.text.document import MappingNode


@dataclass(frozen=True)
class Opening:
    """A spec or a result folder, and the options to open it with.

    Attributes:
        path: The spec, or the result folder.
        settings: Overrides of the spec, each as ADDRESS=VALUE.
        folders: Folders of more components.
        tuned: Whether to start at the tuned values beside the spec, if there are any.
        trusted: Whether to run components of a result that this machine does not know.
        candidate: The candidate of a result: best, a rank or GENERATION:INDEX of a search; best or the number of a run
            of a study.
        results: The folder in which names of other results are looked up, if not the usual one.
    """

    path: Path
    settings: tuple[str, ...] = ()
    folders: tuple[Path, ...] = ()
    tuned: bool = True
    trusted: bool = False
    candidate: str | None = None
    results: Path | None = None

    @property
    def names_result(self) -> bool:
        """Whether the path refers to a result."""
        from gaitsim.results.manifest import is_result

        return is_result(self.path)

    def open(self) -> Opened:
        """Open the spec or the result.

        Raises:
            InvalidSpec: The spec breaks a rule.
            BadResult: The folder is not a result, or the result is damaged.
            Untrusted: The result has components that this machine does not trust.
            Usage: The options do not fit.
        """
        from gaitsim.errors import Usage
        from gaitsim.study.opened import open_result

        if self.names_result:
            return open_result(self.path, self.settings, self.trusted, self.candidate)
        if self.candidate is not None:
            raise Usage(f"--candidate {self.candidate}: {self.path} is a spec; candidates belong to results.")
        return _tuned(self) if self.tuned else _as_written(self)

    def library(self) -> Library:
        """The components that the spec can use.

        Raises:
            Usage: A folder is missing.
        """
        return open_library(self.path, self.folders)

    def document(self) -> MappingNode:
        """The spec with the settings applied.

        Raises:
            InvalidSpec: The spec breaks a rule.
            Usage: A setting is not of the form ADDRESS=VALUE.
        """
        from gaitsim.spec.inheritance import split_setting
        from gaitsim.spec.resolve import read_spec
        from gaitsim.study.foreign import refuse_foreign

        refuse_foreign(self.path)
        return read_spec(self.path, [split_setting(text) for text in self.settings])


def open_library(spec: Path | None, folders: Sequence[Path]) -> Library:
    """The components that a spec can use.

    Args:
        spec: The spec; None for the shipped components only.
        folders: Folders of more components.

    Raises:
        Usage: A folder is missing, or the spec is the copy in a result.
    """
    from gaitsim.components.find import Library, library_folders
    from gaitsim.errors import Usage

    if spec is not None and spec.name == "spec.yaml" and (spec.parent / "manifest.json").is_file():
        rule = "this is the spec of a result, and its components are run with that only"
        raise Usage(f"{spec}: {rule}; name the result, {spec.parent}, or copy the file to a folder of your own.")

    for folder in folders:
        if not folder.is_dir():
            raise Usage(f"--library {folder}: there is no such folder; name one with a folder for each kind.")
    return Library(library_folders(spec, folders))


def _as_written(opening: Opening) -> Opened:
    """Open a spec with its own starts."""
    from gaitsim.study.opened import Opened

    return Opened(opening.document(), opening.library(), opening.path.stem, {}, place=opening.path.parent)


def _tuned(opening: Opening) -> Opened:
    """Open a spec with its tuned values, if there are any.

    A variant without tuned values of its own starts at those of the nearest parent that has some, if it tunes the same
    numbers, or fewer, from the same starts within the same bounds.
    """
    from gaitsim.results.tuned import read_tuned, tuned_path

    opened, spec = _as_written(opening), opening.path
    owner = _owner(spec)
    if owner is None or not (owner == spec or _tunes_what(opened, Opening(owner, folders=opening.folders))):
        return opened
    path = tuned_path(owner)
    free = opened.model().free
    tuned_there = read_tuned(path, free)
    notice = f"tuned values from {path} ({tuned_there.result}); --start ignores them"
    unused = [address for address in tuned_there.values if address not in {each.address for each in free}]
    if unused and owner == spec:
        notice += f"; not tuned here, so without effect: {', '.join(unused)}"
    return replace(opened, starts=tuned_there.values, origin=str(path), notices=(notice,))


def _owner(spec: Path) -> Path | None:
    """The spec or its nearest parent with tuned values; None if there is none."""
    from gaitsim.results.tuned import tuned_path
    from gaitsim.spec.inheritance import parents

    return next((path for path in (spec, *parents(spec)) if tuned_path(path).is_file()), None)


def _tunes_what(opened: Opened, parent: Opening) -> bool:
    """Whether everything that a spec tunes is tuned in the same way in its parent."""
    alike = {(f.address, f.low, f.high, f.start) for f in _as_written(parent).model().free}
    return alike >= {(f.address, f.low, f.high, f.start) for f in opened.model().free}


def started_from(opened: Opened, opening: Opening, origin: str | None) -> tuple[Opened, list[str]]:
    """Change the starts of an opened spec as `--from` says.

    Args:
        opened: The spec.
        opening: How it was opened.
        origin: tuned (values beside the spec or its nearest parent with some), middle (of the bounds), or a result
            folder; None changes nothing.

    Returns:
        The spec with other starts, and notices.

    Raises:
        Usage: The request does not fit.
        BadResult: The folder is not a result, or the result is damaged.
        Untrusted: The result has components that this machine does not trust.
    """
    from gaitsim.errors import Usage
    from gaitsim.results.manifest import result_named
    from gaitsim.results.tuned import read_tuned, tuned_path

    if origin is None:
        return opened, []
    free = opened.model().free
    if origin == "middle":
        where, values = "the middle of all bounds", {f.address: 0.5 * (f.low + f.high) for f in free}
    elif origin == "tuned":
        owner = _owner(opening.path)
        if owner is None:
            raise Usage(f"--from tuned: there is no {tuned_path(opening.path)}; make it with optimize --adopt.")
        where, values = str(tuned_path(owner)), read_tuned(tuned_path(owner), free).values
    else:
        where, result = origin, Opening(result_named(Path(origin), opening.results), trusted=opening.trusted)
        if not result.names_result:
            raise Usage(
                f"--from {where}: this is not a result; write tuned, middle, or a folder of gaitsim results list."
            )
        values = dict(result.open().starts)
    addresses = [f.address for f in free]
    matched = [a for a in addresses if a in values]
    if not matched:
        known = ", ".join(values) or "nothing"
        raise Usage(f"--from {origin}: none of its values ({known}) is tuned here.")
    rest = [a for a in addresses if a not in values]
    notice = f"start from {where}: {', '.join(matched)}" + (f"; not found there: {', '.join(rest)}" if rest else "")
    return replace(opened, starts={a: values[a] for a in matched}, origin=where), [notice]


def only_row(opened: Opened, path: Path) -> Variant:
    """The one run of a spec or result that is not a study.

    Raises:
        Usage: It is a study.
    """
    from gaitsim.errors import Usage
    from gaitsim.spec.study import variants

    rows = variants(opened.document, [])
    if len(rows) > 1:
        raise Usage(f"{path} is a study of {len(rows)} runs; take one with --candidate, or drop it: --set study=null.")
    return rows[0]
