"""gaitsim library: the components, and their declarations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console, library_promote, library_uses
from gaitsim.cli.options import Json, Libraries, Reference
from gaitsim.cli.options import complete_kinds as _kinds
from gaitsim.cli.options import complete_references as _references
from gaitsim.study.opening import open_library

if TYPE_CHECKING:
    from gaitsim.components.composite import ComponentFile
    from gaitsim.components.find import Library
    from gaitsim.errors import Fault

app = typer.Typer(help="List, show, check and create components.", rich_markup_mode=None)


@app.command("list")
def list_components(
    kind: Annotated[
        str, typer.Argument(metavar="[KIND]", help="Only this kind, such as muscle.", autocompletion=_kinds)
    ] = "*",
    library: Libraries = None,
    json: Json = False,
) -> None:
    """List the components of the library, with one sentence each.

    Example: gaitsim library list muscle
    """
    from gaitsim.components.describe import described
    from gaitsim.errors import Usage, did_you_mean

    parts = open_library(None, library or ())
    references = parts.references(kind)
    if not references:
        kinds = {reference.split("/")[0] for reference in parts.references()}
        raise Usage(f"there is no kind {kind}. {did_you_mean(kind, kinds)}")
    found = [described(parts.find(reference)) for reference in references]
    if json:
        console.give_json({"components": found})
    else:
        console.give_table(["component", "what it is"], [(c["use"], c["doc"].split("\n")[0]) for c in found])


@app.command("show")
def show_component(
    reference: Reference,
    plot: Annotated[bool, typer.Option("--plot", help="Draw its curves, such as force over length.")] = False,
    folder: Annotated[Path, typer.Option(metavar="FOLDER", help="Folder for the picture of --plot.")] = Path(),
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="With --plot: value of a parameter; repeatable."),
    ] = None,
    library: Libraries = None,
    json: Json = False,
) -> None:
    """Show what a component declares: parameters, inputs, outputs. Each has its unit and its source.

    Examples:

    gaitsim library show muscle/geyer2003

    gaitsim library show controller/muscle_feedback --plot --set gain=3
    """
    from gaitsim.components.describe import described
    from gaitsim.errors import Usage

    if settings and not plot:
        raise Usage("--set says at which values curves are drawn; add --plot.")
    component = open_library(None, library or ()).find(reference)
    found = described(component)
    picture = _draw_curves(component, settings or [], folder) if plot else None
    if json:
        console.give_json(found | ({"plot": str(picture) if picture else None} if plot else {}))
        return
    console.give(f"{found['use']}  ({found['file']}, {found['digest'][:12]})\n\n{found['doc']}")
    for section, rows in found.items():
        if isinstance(rows, dict) and rows:
            console.give("")
            columns = list(dict.fromkeys(key for row in rows.values() for key in row if _has_value(row[key])))
            table = [(name, *(_cell(row.get(key)) for key in columns)) for name, row in rows.items()]
            console.give_table([section, *columns], table)


@app.command("check")
def check_components(
    what: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[KIND/NAME | PATH]...", help="Components, files or folders (default: the whole library)."
        ),
    ] = None,
    library: Libraries = None,
    json: Json = False,
) -> None:
    """Check component files. The checks are of names, units, documentation, sources, bounds, kind and native code.

    Examples:

    gaitsim library check muscle/geyer2010

    gaitsim library check components
    """
    from gaitsim.components.review import review
    from gaitsim.errors import InvalidComponent

    checked, faults = 0, []
    for reference, parts in _asked(what or [], library):
        found = review(reference, parts)
        faults += found or _of_native_code(reference, parts)
        checked += 1
    if faults:
        raise InvalidComponent(faults)
    if json:
        console.give_json({"status": "valid", "components": checked})
    else:
        console.give(f"{checked} component{'s' if checked != 1 else ''}: valid")


@app.command("new")
def new_component_file(
    kind: Annotated[
        str, typer.Argument(metavar="KIND", help="Kind of the component, such as muscle.", autocompletion=_kinds)
    ],
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the component, such as my_muscle.")],
    folder: Annotated[
        Path, typer.Option(metavar="FOLDER", help="Folder of your specs; components/ and tests/ are created in it.")
    ] = Path(),
    like: Annotated[
        str | None, typer.Option(metavar="KIND/NAME", help="Component to copy.", autocompletion=_references)
    ] = None,
    library: Libraries = None,
    json: Json = False,
) -> None:
    """Create a working component with a test, as a starting point.

    Examples:

    gaitsim library new muscle my_muscle

    gaitsim library new muscle my_muscle --like muscle/geyer2010
    """
    from gaitsim.components.skeleton import new_component, test_of
    from gaitsim.study.new_files import write_new

    parts = open_library(folder / "spec.yaml", library or ())
    file, text = new_component(kind, name, parts, like)
    made = {folder / "components" / kind / file: text}
    if file.endswith(".py"):
        made[folder / "tests" / f"test_{name}.py"] = test_of(kind, name)
    write_new(made, "choose another --folder")
    if json:
        console.give_json({"use": f"{kind}/{name}", "files": [str(path) for path in made]})
        return
    for path in made:
        console.give(str(path))
    console.say(f"a spec in {folder.absolute()} can say use: {kind}/{name}; gaitsim library check {next(iter(made))}")


def _asked(what: list[str], folders: list[Path] | None) -> Iterator[tuple[str, Library]]:
    """Each component that should be checked, with its library."""
    from gaitsim.components.find import Library, display_path
    from gaitsim.components.review import components_in
    from gaitsim.errors import Usage

    everything = open_library(None, folders or ())
    for word in what or [display_path(folder) for folder in everything.folders]:
        path = Path(word)
        if word in everything.references() or not path.exists():
            yield word, everything
            continue
        root, references = components_in(path)
        if not references:
            raise Usage(f"{word}: there is no component in it; name a folder of kinds, such as components.")
        here = Library((root, *(f for f in everything.folders if f.resolve() != root.resolve())))
        yield from ((reference, here) for reference in references)


def _of_native_code(reference: str, parts: Library) -> list[Fault]:
    """The faults that prevent native code of a component."""
    from gaitsim.compiler.kernel import address_of
    from gaitsim.components.primitive import Primitive
    from gaitsim.errors import InvalidComponent

    component = parts.find(reference)
    try:
        if isinstance(component, Primitive):
            address_of(component)
    except InvalidComponent as error:
        return list(error.faults)
    return []


def _draw_curves(component: ComponentFile, settings: list[str], folder: Path) -> Path | None:
    """Draw the curves of a component, or print why there are none."""
    from gaitsim.analysis.models.curves import draw
    from gaitsim.results.store import CannotSave
    from gaitsim.simulation.curves import graphs, why_no_curves

    panels = graphs(component, _values(component, settings))
    if not panels:
        console.say(f"nothing to draw of {component.reference}: {why_no_curves(component)}")
        return None
    picture = folder / f"{component.reference.replace('/', '.')}.curves.png"
    try:
        draw(panels, picture, component.reference)
    except OSError as error:
        raise CannotSave(f"{picture}: {error.strerror}; choose another --folder.") from error
    for name, value in {n: v for panel in panels for n, v in panel.assumed.items()}.items():
        console.say(f"{name} has no default; drawn at {value}. Another: --set {name}=...")
    console.say(f"drawn in {picture}")
    return picture


def _values(component: ComponentFile, settings: list[str]) -> dict[str, float]:
    """Read parameters in SI from NAME=VALUE.

    Raises:
        Usage: The request does not fit.
    """
    from gaitsim.errors import Faults, Usage, did_you_mean
    from gaitsim.spec.inheritance import split_setting
    from gaitsim.text.document import parse_value
    from gaitsim.text.quantity import number

    values, faults = {}, Faults()
    for name, text in map(split_setting, settings):
        if name not in component.parameters:
            hint = did_you_mean(name, component.parameters)
            raise Usage(f"--set {name}: {component.reference} has no such parameter. {hint}")
        value = number(parse_value(text, f"--set {name}={text}"), component.parameters[name].unit, faults, name)
        if value is not None:
            values[name] = value
    faults.raise_if_any(Usage)
    return values


def _has_value(value: Any) -> bool:
    """Whether a field has a value. Fields without a value in any row get no column."""
    return value is not None and value is not False and value not in ("", (), [], {})


def _cell(value: Any) -> str:
    if not _has_value(value):
        return ""
    if isinstance(value, Mapping):
        return ", ".join(f"{name} = {_cell(item)}" for name, item in value.items())
    if value is True:
        return "yes"
    if isinstance(value, list | tuple):
        pairs = all(isinstance(item, list | tuple) and len(item) == 2 for item in value)
        return ", ".join(" = ".join(map(_cell, item)) if pairs else _cell(item) for item in value)
    return f"{value:g}" if isinstance(value, float | int) and not isinstance(value, bool) else str(value)


app.command("used-by")(library_uses.used_by)
app.command("test")(library_uses.test)
app.command("promote")(library_promote.promote)
app.command("history")(library_uses.history)
