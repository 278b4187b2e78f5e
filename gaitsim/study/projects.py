"""Projects: folders in a lab, each with a model that was copied from a result or a spec, and the work of one
researcher.

A project is marked by a file of its own, and a lab by a file that never changes. Two people therefore never write the
same file.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.cluster.episodes import episode_models
from gaitsim.components.find import is_component
from gaitsim.components.load import as_lines
from gaitsim.components.places import LAB, PROJECT, lab_of
from gaitsim.distribution import shipped_folder, shipped_specs
from gaitsim.errors import InvalidSpec, Usage, did_you_mean
from gaitsim.results.bundle import COMPONENTS, SPEC, Bundle
from gaitsim.results.manifest import is_result, read_result, result_named
from gaitsim.results.provenance import author
from gaitsim.results.tuned import tuned_path, tuned_text
from gaitsim.spec.study import variants
from gaitsim.study.new_files import write_new
from gaitsim.study.opening import Opening
from gaitsim.study.template import feedback_of
from gaitsim.text.document import dump, parse, plain, read

if TYPE_CHECKING:
    from gaitsim.study.opened import Opened

_PROJECTS = "projects"
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,63}")
_LAB_TEXT = (
    "format: 1\nabout: A lab. Its library/ serves every spec below it; projects/ has a folder for each project.\n"
)
_IGNORED = "results/\nanalysis/\n*.partial\n"
_VARIANT = """\
gaitsim: 1
about: {name}, from {origin}.

extends: {origin}.yaml
# What differs from it stands here, such as a part with a component of your own:
#
# parts:
#   {part}: {{use: controller/my_reflex}}
"""
_README = """\
# {name}

Started by {author} on {day} from {where}.

| file | what it is |
|---|---|
| `{name}.yaml` | the model of this project: what differs from `{origin}.yaml` |
| `{name}.tuned.yaml` | the values that it starts at; `gaitsim optimize {name}.yaml --adopt` replaces them |
| `{origin}.yaml` | the model that it began with, copied; leave it as it is |
| `components/` | components of this project, which go before those of the lab and of gaitsim |

{copied}

## Next steps

    gaitsim show {name}.yaml                       # parts, and which library has each
    gaitsim run {name}.yaml
    gaitsim library new controller my_reflex       # a component of your own
    gaitsim optimize {name}.yaml --generations 2   # a brief search

A search starts at the values that `{name}.yaml` itself has. `--from tuned` starts it at those in `{name}.tuned.yaml`,
which `run` and `analyze` use.

What differs from the beginning, in the model and in its gait:

    gaitsim results compare {compared} results/RESULT
"""


@dataclass(frozen=True)
class Project:
    """A project: its folder, name, author, date, and the origin of its model."""

    folder: Path
    name: str
    author: str
    date: str
    origin: str

    @property
    def spec(self) -> Path:
        """The spec of its model."""
        return self.folder / f"{self.name}.yaml"


def projects(place: Path) -> list[Project]:
    """The projects of the lab that a folder belongs to, by name. A project with a damaged file has its folder only."""
    lab = lab_of(place)
    if lab is None:
        raise Usage(f"no folder above this one has a {LAB}, so this is not a lab; gaitsim new project NAME makes one.")
    return [_read(path) for path in sorted((lab / _PROJECTS).glob(f"*/{PROJECT}"))]


def _read(path: Path) -> Project:
    try:
        found = plain(read(path))
    except (InvalidSpec, OSError):
        found = {}
    fields = [str(found.get(key, "damaged")) for key in ("author", "date", "from")]
    return Project(path.parent, path.parent.name, *fields)


@dataclass(frozen=True)
class NewProject:
    """A new project: its files by path, and the components that were copied, with the reason."""

    project: Project
    files: tuple[Path, ...]
    copied: Mapping[str, str]


def new_project(name: str, origin: str, place: Path, results: Path | None = None, trusted: bool = False) -> NewProject:
    """Make a project in the lab that a folder belongs to. Without a lab, the folder becomes one.

    Args:
        name: The name of the project and of its spec.
        origin: A result, a spec, or the name of a shipped spec, whose model and tuned values are copied.
        place: The folder in which the command is given.
        results: The folder in which names of results are looked up.
        trusted: Whether to load components of a result that this machine does not know.

    Raises:
        Usage, BadResult, Untrusted, InvalidSpec, InvalidComponent, CannotSave: Nothing is left behind then.
    """
    lab = lab_of(place) or place
    folder = _free_folder(name, lab)
    opening = _opening(origin, results, trusted)
    opened = opening.open()
    model = opened.model()
    bundle = _bundle(opening, opened)
    called = opened.name if opened.name.lower() != name.lower() else f"{opened.name}_origin"
    copied = _lacking(bundle, [lab / "library", shipped_folder()])
    project = Project(folder, name, author(), date.today().isoformat(), _where(opening, opened, origin))
    texts = {
        f"{called}.yaml": _spec_text(opening, bundle),
        f"{name}.yaml": _VARIANT.format(name=name, origin=called, part=feedback_of(opened.document) or "feedback"),
        PROJECT: _marker(project, bundle),
        "README.md": _readme(project, called, copied, opening),
        ".gitignore": _IGNORED,
        **{path: bundle.files[path] for path in copied},
    }
    texts |= {} if copied else {f"{COMPONENTS}/.gitkeep": ""}
    values = {free.address: free.start for free in model.free if free.address in opened.starts}
    if values:
        tuned = tuned_text(
            project.origin, opened.recorded.get("score"), values, {f.address: f.unit for f in model.free}
        )
        texts |= {tuned_path(Path(f"{stem}.yaml")).name: tuned for stem in (called, name)}
    marker = {} if (lab / LAB).is_file() else {lab / LAB: _LAB_TEXT}
    files = marker | {folder / path: text for path, text in texts.items()}
    write_new(files, "give the command in a folder that you may write to")
    return NewProject(project, tuple(files), copied)


def _free_folder(name: str, lab: Path) -> Path:
    """Find the folder of a new project.

    Raises:
        Usage: A name that cannot be one, or that is taken.
    """
    if not _NAME.fullmatch(name):
        rule = "a project's name is that of its folder and its spec: letters, digits, _ and -, a letter first"
        raise Usage(f"{name}: {rule}; choose such a name.")
    folder = lab / _PROJECTS / name
    taken = next((p for p in sorted((lab / _PROJECTS).glob("*")) if p.name.lower() == name.lower()), None)
    if taken is not None:
        known = _read(taken / PROJECT) if (taken / PROJECT).is_file() else None
        by = f", started by {known.author} on {known.date}" if known else ""
        raise Usage(f"{name}: {taken} exists already{by}; nothing was changed. Choose another name.")
    return folder


def _opening(origin: str, results: Path | None, trusted: bool) -> Opening:
    """What to open as the origin of a project.

    Raises:
        Usage: It is neither a result nor a spec.
    """
    named = result_named(Path(origin), results)
    if is_result(named):
        return Opening(named, trusted=trusted)
    if named.is_file():
        return Opening(named)
    shipped = shipped_specs()
    if origin in shipped:
        return Opening(shipped[origin])
    rule = "this is neither a result, nor a spec, nor a shipped model"
    raise Usage(f"--from {origin}: {rule}. {did_you_mean(origin, shipped)}")


def _where(opening: Opening, opened: Opened, origin: str) -> str:
    """The origin of a project in words. The name of a result is enough, wherever its folder lies."""
    if opened.manifest:
        return f"{opening.path.name}"
    return origin


def _bundle(opening: Opening, opened: Opened) -> Bundle:
    """Everything that a result or a spec is made of, with all runs of its study and all episodes of its search."""
    if opening.names_result:
        return read_result(opening.path)[1]
    runs = [opened.model(row.document) for row in variants(opened.document, [])]
    return opened.bundle([*runs, *episode_models(opened.document, opened.library, opened.name)])


def _spec_text(opening: Opening, bundle: Bundle) -> str:
    """The spec as written. A spec with parents is merged with them; that of a result is as the result has it."""
    if not opening.names_result:
        text = opening.path.read_text(encoding="utf-8")
        if "extends" not in parse(text, str(opening.path)).entries:
            return text
    return bundle.files[SPEC]


def _lacking(bundle: Bundle, libraries: list[Path]) -> dict[str, str]:
    """The component files of a bundle that these libraries lack or have in another version, with the reason."""
    found = {}
    for path, text in sorted(bundle.files.items()):
        inner = path.removeprefix(f"{COMPONENTS}/")
        if inner == path:
            continue
        there = next((library / inner for library in libraries if (library / inner).is_file()), None)
        if there is None:
            found[path] = "no library has it"
        elif as_lines(there.read_text(encoding="utf-8")) != text:
            found[path] = f"it differs from {there}"
    return found


def _marker(project: Project, bundle: Bundle) -> str:
    return dump(
        {
            "format": 1,  # not `gaitsim`, which would say that this is a spec
            "project": project.name,
            "author": project.author,
            "date": project.date,
            "from": project.origin,
            "digest": bundle.digest,
        }
    )


def _readme(project: Project, origin: str, copied: Mapping[str, str], opening: Opening) -> str:
    own = [path for path in copied if is_component(Path(path))]
    sentence = f"Copied from there, because no library serves them as they were: {', '.join(f'`{p}`' for p in own)}."
    return _README.format(
        name=project.name,
        author=project.author,
        day=project.date,
        where=f"`{project.origin}`",
        origin=origin,
        copied=sentence if own else "All its components are served by the libraries of the lab and of gaitsim.",
        compared=os.path.relpath(opening.path, project.folder) if opening.names_result else f"{origin}.yaml",
    )


def project_data(project: Project) -> dict[str, Any]:
    """A project as plain data."""
    return {
        "name": project.name,
        "author": project.author,
        "date": project.date,
        "from": project.origin,
        "folder": str(project.folder),
        "spec": str(project.spec),
    }
