"""The search path of components: beside the spec, in given folders, in its project and lab, and the shipped library."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from gaitsim.components.checks.shared import Shared, imported_names, whole
from gaitsim.components.composite import ComponentFile, load_composite
from gaitsim.components.contract import kind_faults
from gaitsim.components.load import as_lines, digest_of, load_primitive
from gaitsim.components.places import lab_of, project_of, serves
from gaitsim.components.table import Table, load_table
from gaitsim.distribution import shipped_folder
from gaitsim.errors import Fault, GaitsimError, InvalidSpec, Mark, did_you_mean, nearest
from gaitsim.text.document import text_of

_SUFFIXES = (".py", ".yaml")
_LONGEST = 200  # letters; file systems do not have longer names
KIND = "kind.yaml"  # the contract of a kind
SKELETON = "_skeleton.py"  # the template of `gaitsim library new`


def is_component(path: Path) -> bool:
    """Whether a file in the folder of a kind is a component that specs can use."""
    return path.name != KIND and not path.name.startswith("_") and path.suffix in _SUFFIXES


def library_folders(spec: Path | None, extra: Iterable[Path] = ()) -> tuple[Path, ...]:
    """The search path of a spec, nearest first.

    Of the folders above the spec, only a marked project and a marked lab count.

    Args:
        spec: The spec; None for the shipped library only.
        extra: Folders of more components.
    """
    beside = (spec or Path.cwd() / "x").absolute().parent
    project, lab = project_of(beside), lab_of(beside)
    near = (lab or beside) / "library"
    own = [project / "components"] if project else []
    folders = [beside / "components", *extra, *own, near, shipped_folder()]
    return _distinct(folder for folder in folders if folder.is_dir())


def _distinct(folders: Iterable[Path]) -> tuple[Path, ...]:
    """Each folder once, at its first position."""
    found: dict[Path, Path] = {}
    for folder in folders:
        found.setdefault(folder.resolve(), folder)
    return tuple(found.values())


@dataclass
class Library:
    """Components by reference. Each is loaded once.

    Attributes:
        texts: All files, for a library whose files were read before; no file is then read again.
    """

    folders: tuple[Path, ...]
    texts: Mapping[Path, str] | None = None
    notices: list[str] = field(default_factory=list)
    _loaded: dict[str, ComponentFile] = field(default_factory=dict)
    _tables: dict[str, Table] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.folders = _distinct(self.folders)

    def find(self, reference: str) -> ComponentFile:
        """Load a component.

        Args:
            reference: Kind and name, such as muscle/geyer2003.

        Raises:
            InvalidSpec: There is no such component.
            InvalidComponent: Its file has faults.
        """
        if reference not in self._loaded:
            self._loaded[reference] = self._load(reference)
        return self._loaded[reference]

    def references(self, kind: str = "*") -> list[str]:
        """All references that specs can use, or those of one kind, sorted."""
        if kind != "*" and not kind.isidentifier():
            return []
        found = {
            f"{path.parent.name}/{path.stem}"
            for folder in self.folders
            for suffix in _SUFFIXES
            for path in self._matching(folder, kind, suffix)
            if is_component(path)
        }
        return sorted(found)

    def path(self, reference: str) -> Path | None:
        """The file of a component; None if there is none. Nothing is loaded."""
        return next(iter(self._files(reference)), None)

    def file(self, reference: str) -> Path | None:
        """The file of a component or a table; None if there is none. Nothing is loaded."""
        return next(iter(self._files(reference, (*_SUFFIXES, ".csv"))), None)

    def version(self, reference: str) -> str | None:
        """The digest of a component or a table.

        It is computed from the text, without running it.

        Returns:
            The digest; None if there is no such component or table.

        Raises:
            InvalidSpec: The file cannot be read.
        """
        path = self.file(reference)
        if path is None:
            return None
        text = as_lines(self._text(path, "component").removeprefix("\ufeff"))
        return digest_of(whole(text, self.shared(path.parent.name, text) if path.suffix == ".py" else ()))

    def serves(self, reference: str) -> str:
        """The library that a loaded component comes from: shipped, lab, project, result, or a folder."""
        path = self.find(reference).path
        word = serves(path.parents[1], shipped_folder())
        return display_path(path.parents[1]) if word == str(path.parents[1]) else word

    def used(self) -> dict[str, ComponentFile]:
        """The components that were loaded, by reference."""
        return dict(sorted(self._loaded.items()))

    def table(self, reference: str) -> Table:
        """Read a table of recorded curves.

        Args:
            reference: Folder and name, such as norms/fukuchi2018_walking.

        Raises:
            InvalidSpec: There is no such table, or it has faults.
        """
        if reference not in self._tables:
            tables = (p for folder in reversed(self.folders) for p in self._matching(folder, "*", ".csv"))
            paths = {f"{p.parent.name}/{p.stem}": p for p in tables}
            if reference not in paths:
                raise InvalidSpec(Fault(f"there is no table {reference}. {did_you_mean(reference, paths)}"))
            path = paths[reference]
            self._tables[reference] = load_table(path, display_path(path), self._text(path, "table"))
        return self._tables[reference]

    def used_tables(self) -> dict[str, Table]:
        """The tables that were read, by reference."""
        return dict(sorted(self._tables.items()))

    def contract(self, kind: str) -> tuple[Path, str] | None:
        """The contract of a kind: the file and its text; None if the kind has none.

        Raises:
            InvalidSpec: The file cannot be read.
        """
        path = next((f / kind / KIND for f in self.folders if self._has(f / kind / KIND)), None)
        return (path, self._text(path, "contract")) if path else None

    def shared(self, kind: str, text: str) -> list[Shared]:
        """The shared files that a component imports from, as far as they exist.

        Args:
            kind: The kind of the component.
            text: The text of the component.

        Raises:
            InvalidSpec: A file cannot be read.
        """
        found = []
        for name in imported_names(text):
            files = [f / kind / f"{name}.py" for f in self.folders if self._has(f / kind / f"{name}.py")]
            if files:
                found.append(Shared(name, files[0], display_path(files[0]), as_lines(self._text(files[0], "file"))))
        return found

    def _load(self, reference: str) -> ComponentFile:
        files = self._files(reference)
        if not files:
            raise InvalidSpec(self.unknown(reference))
        path = files[0]
        twins = [f for f in files if f.parent == path.parent]
        if len(twins) > 1:
            both = " and ".join(display_path(f) for f in twins)
            raise InvalidSpec(Fault(f"{reference} is both {both}; remove one of them."))
        loaded = self._read(reference, path)
        contract = self.contract(loaded.kind)
        faults = kind_faults(loaded, contract[1], display_path(path), display_path(contract[0])) if contract else []
        if faults:
            raise InvalidSpec(faults)
        for hidden in files[1:]:
            if as_lines(self._text(hidden, "component")) != loaded.text:
                self.notices.append(f"{display_path(path)} hides {display_path(hidden)}")
        return loaded

    def _read(self, reference: str, path: Path) -> ComponentFile:
        text = self._text(path, "component")
        if path.suffix == ".yaml":
            return load_composite(reference, path, display_path(path), text)
        return load_primitive(reference, path, display_path(path), text, self.shared(path.parent.name, text))

    def _files(self, reference: str, suffixes: Sequence[str] = _SUFFIXES) -> list[Path]:
        kind, _, name = reference.partition("/")
        if not (kind.isidentifier() and name.isidentifier()) or len(reference) > _LONGEST:
            return []
        paths = [folder / kind / f"{name}{suffix}" for folder in self.folders for suffix in suffixes]
        return [path for path in paths if self._has(path)]

    def _has(self, path: Path) -> bool:
        return path.is_file() if self.texts is None else path in self.texts

    def _text(self, path: Path, what: str) -> str:
        """The text of a file. A link may lead to a file of another type; messages never quote that."""
        if self.texts is not None:
            return self.texts[path]
        real = path.resolve()
        if real.suffix != path.suffix:
            rule = f"this links to {real}, which is not a {path.suffix} file"
            raise InvalidSpec(Fault(f"{rule}; name a {what} of your own.", Mark(display_path(path))))
        return text_of(path, display_path(path), what)

    def _matching(self, folder: Path, kind: str, suffix: str) -> list[Path]:
        """The files with a suffix, of one kind or of all kinds (*)."""
        if self.texts is None:
            return sorted(folder.glob(f"{kind}/*{suffix}"))
        return sorted(
            path
            for path in self.texts
            if path.parent.parent == folder and kind in ("*", path.parent.name) and path.suffix == suffix
        )

    def kinds(self) -> set[str]:
        """All kinds that have a component."""
        return {reference.split("/")[0] for reference in self.references()}

    def unknown(self, reference: str) -> str:
        """The message for a reference that names no component."""
        kind, slash, name = reference.partition("/")
        if not slash:
            twins = [known for known in self.references() if known.endswith(f"/{reference}")]
            hint = f"Did you mean {twins[0]}?" if twins else f"Kinds are {', '.join(sorted(self.kinds()))}."
            return f"{reference} names no kind; write use: kind/name. {hint}"
        if kind not in self.kinds():
            return f"there is no kind {kind}. {did_you_mean(kind, self.kinds())}"
        near = nearest(name, [known.partition("/")[2] for known in self.references(kind)])
        hint = f"Did you mean {kind}/{near}?" if near else did_you_mean("", self.references(kind))
        return f"there is no component {reference}. {hint}"


def display_path(path: Path) -> str:
    """A path as messages show it: relative if that is shorter."""
    try:
        return str(path.absolute().relative_to(Path.cwd()))
    except ValueError:
        return str(path)


def faults_at(mark: Mark, address: str, error: GaitsimError) -> list[Fault]:
    """The faults of an error, with places.

    Args:
        mark: The place where the spec uses the component; for faults without a place.
        address: The address of the part.
        error: The error.
    """
    return [f if f.mark else Fault(f.message, mark, address) for f in error.faults]
