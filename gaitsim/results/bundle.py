"""Bundles: a spec and a copy of every component file that it uses. A bundle runs on any machine."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from gaitsim.errors import Fault, GaitsimError, Mark
from gaitsim.model import Model
from gaitsim.components.find import Library, display_path
from gaitsim.components.load import as_lines
from gaitsim.text.document import MappingNode, dump, parse, plain, text_of
from gaitsim.components.primitive import Primitive
from gaitsim.spec.inheritance import without_marked
from gaitsim.spec.resolve import resolve

SPEC, COMPONENTS, START, COHORT = "spec.yaml", "components", "start.json", "cohort.json"
_SUFFIXES = (".py", ".yaml", ".csv")


class BadResult(GaitsimError):
    """The folder is not a result, or the result is damaged."""


@dataclass(frozen=True)
class Bundle:
    """Texts by relative path: spec.yaml and components/kind/name.*, and the folder that errors name.

    A bundle is read once. Its digest, the decision whether it may run, and the model all follow from the same texts.
    """

    name: str
    files: dict[str, str]
    folder: Path = field(default=Path(), compare=False)

    @property
    def digest(self) -> str:
        """One digest of all names and texts."""
        whole = hashlib.sha256(self.name.encode())
        for path, text in sorted(self.files.items()):
            whole.update(f"\0{path}\0{text}".encode())
        return whole.hexdigest()

    @property
    def digests(self) -> dict[str, str]:
        """The digest of each text, by path."""
        return {path: hashlib.sha256(text.encode()).hexdigest() for path, text in sorted(self.files.items())}

    def write(self, folder: Path) -> None:
        """Write the files below a folder.

        Raises:
            OSError: A file cannot be written.
        """
        for path, text in self.files.items():
            target = folder / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")

    def document(self) -> MappingNode:
        """The spec as a document.

        Raises:
            InvalidSpec: It cannot be read.
        """
        return parse(self.files[SPEC], str(self.folder / SPEC))

    def library(self) -> Library:
        """The library with the components of the bundle only."""
        inside = {self.folder / path: text for path, text in self.files.items() if path.startswith(f"{COMPONENTS}/")}
        return Library((self.folder / COMPONENTS,), inside)

    def starts(self) -> dict[str, float]:
        """The tuned values to start from, in SI by address.

        Raises:
            BadResult: They cannot be read.
        """
        if START not in self.files:
            return {}
        try:
            found = json.loads(self.files[START])
            return {str(address): float(value) for address, value in found.items()}
        except (ValueError, TypeError, AttributeError, OverflowError, RecursionError) as error:
            rule = "this is not a mapping of addresses to numbers; restore this file from a copy."
            raise BadResult(Fault(rule, Mark(str(self.folder / START)))) from error

    def model(self) -> Model:
        """The model at its starts.

        Raises:
            InvalidSpec: The spec breaks a rule.
            InvalidComponent: A component file breaks the contract.
            BadResult: The folder is not a result, or the result is damaged.
        """
        model = resolve(self.document(), self.library(), self.name)
        return model.started_at(self.starts(), str(self.folder / START))


def bundled(
    document: MappingNode, name: str, library: Library, starts: Mapping[str, float], models: Iterable[Model]
) -> Bundle:
    """Make the bundle of a spec.

    Keys that every model dropped when a part was replaced are left out.

    Args:
        document: The spec.
        name: Its name.
        library: The components.
        starts: Tuned values in SI by address.
        models: The models that were resolved from the spec.
    """
    dropped = frozenset.intersection(*(model.dropped for model in models))
    files = {SPEC: dump(plain(without_marked(document, dropped)))}
    if starts:
        files[START] = json.dumps(dict(starts), indent=2) + "\n"
    for reference, component in library.used().items():
        files[f"{COMPONENTS}/{reference}{component.path.suffix}"] = component.text
        if isinstance(component, Primitive):
            for file in component.shared:
                files[f"{COMPONENTS}/{component.kind}/{file.name}.py"] = file.text
        contract = library.contract(component.kind)
        if contract:
            files[f"{COMPONENTS}/{component.kind}/kind.yaml"] = contract[1]
    for reference, table in library.used_tables().items():
        files[f"{COMPONENTS}/{reference}{table.path.suffix}"] = table.text
    return Bundle(name, files)


def read_bundle(folder: Path, name: str) -> Bundle:
    """Read the bundle in a result folder; files may be links.

    Raises:
        BadResult: A file is missing or is not text.
    """
    try:
        inside = [path for path in (folder / COMPONENTS).glob("*/*") if path.suffix in _SUFFIXES]
    except OSError as error:
        rule = f"{folder / COMPONENTS}: this cannot be read ({error.strerror or error}); restore it from a copy."
        raise BadResult(rule) from error
    more = [path for path in (folder / START, folder / COHORT) if path.exists() or path.is_symlink()]
    paths = [folder / SPEC, *more, *sorted(inside)]
    return Bundle(name, {path.relative_to(folder).as_posix(): _text(path) for path in paths}, folder)


def _text(path: Path) -> str:
    r"""The text of a file in a result, with "\n" at the end of lines."""
    try:
        return as_lines(text_of(path, display_path(path), "copy"))
    except GaitsimError as error:
        rules = [re.split("[;.] ", fault.message)[0].rstrip(".") for fault in error.faults]
        raise BadResult([Fault(f"{rule}; restore it from a copy.", Mark(display_path(path))) for rule in rules]) from error
