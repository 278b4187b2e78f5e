"""What a model is made of, as files: its spec and a copy of every component. It re-runs anywhere."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from collections.abc import Mapping as Map
from dataclasses import dataclass
from pathlib import Path

from gaitsim.model import Model
from gaitsim.parts.find import Library
from gaitsim.spec.document import Mapping, dump, parse, plain
from gaitsim.spec.inheritance import without_marked
from gaitsim.spec.resolve import resolve

SPEC, COMPONENTS, START = "spec.yaml", "components", "start.json"
_SUFFIXES = (".py", ".yaml", ".csv")


@dataclass(frozen=True)
class Bundle:
    """Texts by relative path: spec.yaml and components/kind/name.*."""

    name: str
    files: dict[str, str]

    @property
    def digest(self) -> str:
        """One digest over all names and texts."""
        whole = hashlib.sha256(self.name.encode())
        for path, text in sorted(self.files.items()):
            whole.update(f"\0{path}\0{text}".encode())
        return whole.hexdigest()

    def write(self, folder: Path) -> None:
        """Write the files below a folder. Errors: OSError."""
        for path, text in self.files.items():
            target = folder / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")


def bundled(
    document: Mapping, name: str, library: Library, starts: Map[str, float], models: Iterable[Model]
) -> Bundle:
    """The bundle of a spec and its resolved models; `starts` are tuned values by address.

    What every model dropped when a part was swapped is left out: the text no longer says who had it.
    """
    dropped = frozenset.intersection(*(model.dropped for model in models))
    files = {SPEC: dump(plain(without_marked(document, dropped)))}
    if starts:
        files[START] = json.dumps(dict(starts), indent=2) + "\n"
    for reference, component in library.used().items():
        files[f"{COMPONENTS}/{reference}{component.path.suffix}"] = component.source
        contract = library.kind_file(component.kind)
        if contract:
            files[f"{COMPONENTS}/{component.kind}/kind.yaml"] = contract.read_text(encoding="utf-8")
    for reference, table in library.used_tables().items():
        files[f"{COMPONENTS}/{reference}{table.path.suffix}"] = table.source
    return Bundle(name, files)


def read_bundle(folder: Path, name: str) -> Bundle:
    """The bundle that lies in a result folder. Errors: OSError, UnicodeDecodeError."""
    paths = [path for path in sorted((folder / COMPONENTS).rglob("*")) if path.suffix in _SUFFIXES]
    paths += [folder / SPEC, *([folder / START] if (folder / START).is_file() else [])]
    return Bundle(name, {path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8") for path in paths})


def bundle_document(folder: Path) -> Mapping:
    """The spec of a bundle. Errors: OSError, InvalidSpec."""
    return parse((folder / SPEC).read_text(encoding="utf-8"), str(folder / SPEC))


def bundle_library(folder: Path) -> Library:
    """The components of a bundle, and no others."""
    return Library((folder / COMPONENTS,))


def bundle_starts(folder: Path) -> dict[str, float]:
    """The tuned values that a bundle starts from. Errors: OSError, ValueError."""
    path = folder / START
    return dict(json.loads(path.read_text(encoding="utf-8"))) if path.is_file() else {}


def bundle_model(folder: Path, name: str) -> Model:
    """The model of a bundle. Errors: OSError, InvalidSpec, InvalidComponent."""
    model = resolve(bundle_document(folder), bundle_library(folder), name)
    return model.started_at(bundle_starts(folder), str(folder / START))
