"""A page for each kind of component, from the declarations and docstrings of its files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from itertools import groupby
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import matplotlib as mpl
import yaml
from parts_of_text import Page, code, escaped, number, paragraphs, table
from references import linked

from gaitsim.analysis.models.curves import draw
from gaitsim.components.composite import ComponentFile
from gaitsim.components.describe import described
from gaitsim.components.find import KIND, Library
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.curves import graphs

FOLDER = "reference/components"
_OVERVIEW = """\
# Components

Every part of a spec names a component by `use: kind/name`. These pages are generated from the component files in
`library/`. `gaitsim library show KIND/NAME` prints the same declarations, and `--plot` draws the same curves.

Inside equations, `p` has the parameters, `u` the inputs, `x` the states, `y` the outputs and `m` the metrics; all
are in SI, with angles in radians. [Design](../../design.md#the-component-contract) explains the contract.
"""
# Section of a description: its heading, then column heads with the field of each.
_SECTIONS: Mapping[str, tuple[str, Mapping[str, str]]] = {
    "parameters": (
        "Parameters",
        {
            "meaning": "doc",
            "default": "default",
            "unit": "unit",
            "bounds": "bounds",
            "whole": "whole",
            "source": "source",
        },
    ),
    "series": ("Recorded curves and lists", {"meaning": "doc", "unit": "unit", "values": "size"}),
    "points": ("Points", {"meaning": "doc", "unit": "unit"}),
    "options": ("Options", {"meaning": "doc", "choices": "choices", "default": "default"}),
    "attachments": ("Attachments", {"meaning": "doc"}),
    "frames": ("Frames", {"meaning": "doc", "stands for": "is"}),
    "links": ("Links", {"meaning": "doc"}),
    "inputs": ("Inputs", {"meaning": "doc", "unit": "unit", "default": "default", "summed": "sums", "goes to": "is"}),
    "outputs": ("Outputs", {"meaning": "doc", "unit": "unit", "comes from": "is"}),
    "states": ("States", {"meaning": "doc", "unit": "unit"}),
    "metrics": ("Metrics", {"meaning": "doc", "unit": "unit"}),
    "parts": ("Inner parts", {"meaning": "doc", "kind": "kind", "default": "default", "component": "use"}),
    "step_limits": ("Largest step", {"step": "value", "unit": "unit", "measured by": "doc"}),
}


@cache
def _library() -> Library:
    return Library((shipped_folder(),))


@cache
def kinds() -> tuple[str, ...]:
    """The kinds of components, sorted."""
    return tuple(kind for kind, _ in groupby(_library().references(), lambda reference: reference.split("/")[0]))


def path_of(kind: str) -> str:
    """The path of the page of a kind, below docs/."""
    return f"{FOLDER}/{kind}.md"


def pages() -> Iterator[Page]:
    """The overview, the page of each kind, and the pictures on them."""
    rows = [(f"[{kind}]({kind}.md)", escaped(_about(kind)), str(len(_library().references(kind)))) for kind in kinds()]
    yield Page(f"{FOLDER}/index.md", _OVERVIEW + "\n" + table(["kind", "what it is", "components"], rows))
    for kind in kinds():
        texts = [f"# {kind}\n\n{escaped(_about(kind))}\n"]
        for reference in _library().references(kind):
            component = _library().find(reference)
            picture = _curves(component)
            texts.append(_text(component, picture.path if picture else ""))
            if picture:
                yield picture
        yield Page(path_of(kind), "\n".join(texts))


def _about(kind: str) -> str:
    file = shipped_folder() / kind / KIND
    return str(yaml.safe_load(file.read_text(encoding="utf-8")).get("about", "")) if file.is_file() else ""


def _text(component: ComponentFile, picture: str) -> str:
    """The part of a page that is about one component."""
    found = described(component)
    parts = [f"## {escaped(component.reference)} {{#{component.reference.split('/')[1]}}}", paragraphs(component.doc)]
    if picture:
        parts.append(f"![Curves of {escaped(component.reference)}]({picture.removeprefix(FOLDER + '/')})")
    for section, (heading, columns) in _SECTIONS.items():
        rows = found.get(section)
        if rows:
            parts.append(f"**{heading}**\n\n{_table(rows, columns)}")
    language = "python" if component.path.suffix == ".py" else "yaml"
    body = "\n".join(f"    {line}".rstrip() for line in component.text.splitlines())
    parts.append(f'??? abstract "{found["file"]}"\n\n    ```{language}\n{body}\n    ```')
    return "\n\n".join(parts) + "\n"


def _table(rows: Mapping[str, Mapping[str, Any]], columns: Mapping[str, str]) -> str:
    cells = [[code(name), *(_cell(field, row.get(field)) for field in columns.values())] for name, row in rows.items()]
    return table(["name", *columns], cells)


def _cell(field: str, value: Any) -> str:
    if field in ("sums", "whole"):
        return "yes" if value else ""
    if field == "source":
        return linked(value or "", depth=FOLDER.count("/") + 1)
    if field in ("is", "choices"):
        return ", ".join(code(word) for word in ([value] if isinstance(value, str) else value or []))
    if isinstance(value, Mapping):
        return code(str(value.get("value", "")))
    return number(value)


def _curves(component: ComponentFile) -> Page | None:
    """The picture of a component's curves, the one that `gaitsim library show --plot` draws; None if it has none."""
    panels = graphs(component)
    if not panels:
        return None
    name = component.reference.replace("/", ".")
    with TemporaryDirectory() as folder, mpl.rc_context({"svg.hashsalt": name}):
        file = Path(folder) / f"{name}.svg"
        draw(panels, file, component.reference)
        return Page(f"{FOLDER}/curves/{name}.svg", file.read_bytes())
