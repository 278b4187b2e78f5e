"""Options and arguments that several commands share, and the model they ask for."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from gaitsim.components.find import Library
    from gaitsim.model import Model
    from gaitsim.text.document import Mapping


def complete_references(incomplete: str) -> list[str]:
    """Components, for the shell's completion."""
    return [reference for reference in open_library(None, None).references() if reference.startswith(incomplete)]


def complete_kinds(incomplete: str) -> list[str]:
    """Kinds of components, for the shell's completion."""
    return sorted(kind for kind in open_library(None, None).kinds() if kind.startswith(incomplete))


Reference = Annotated[
    str,
    typer.Argument(
        metavar="KIND/NAME", help="Component, such as muscle/geyer2003.", autocompletion=complete_references
    ),
]
Spec = Annotated[
    Path, typer.Argument(metavar="SPEC", help="A spec, such as specs/hopping_geyer2003.yaml, or a result folder.")
]
Set = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="ADDRESS=VALUE", help="Override a value of the spec; repeatable."),
]
Libraries = Annotated[
    list[Path] | None,
    typer.Option("--library", metavar="FOLDER", help="Additional folder of components; repeatable."),
]
Trust = Annotated[bool, typer.Option("--trust", help="Run a result's components even if this machine did not make it.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON document on stdout.")]


RESULTS = Path("results")
_TIME = "write a time, such as '2 s' or '300 ms'."


class ModeName(StrEnum):
    """The two ways of running a model."""

    rapid = "rapid"
    normal = "normal"


def seconds_of(option: str, text: str | None) -> float | None:
    """A time such as '2 s', '300 ms' or 2. Errors: Usage."""
    from gaitsim.errors import Usage
    from gaitsim.text.quantity import in_plain_letters
    from gaitsim.units import UnknownUnit, parse_quantity, parse_unit

    if text is None:
        return None
    try:
        quantity = parse_quantity(text)
    except UnknownUnit:
        quantity = None
    if quantity is None or (quantity.unit.text != "1" and quantity.unit.dimension != parse_unit("s").dimension):
        raise Usage(f"{option} {text}: {in_plain_letters(text) or _TIME}")
    return quantity.value


def open_library(spec: Path | None, folders: list[Path] | None) -> Library:
    """The components that a spec can use.

    Errors: Usage if a folder is missing, or if the spec is the copy that a result holds.
    """
    from gaitsim.components.find import Library, library_folders
    from gaitsim.errors import Usage

    if spec is not None and spec.name == "spec.yaml" and (spec.parent / "manifest.json").is_file():
        rule = "this is the spec of a result, and its components are run with that only"
        raise Usage(f"{spec}: {rule}; name the result, {spec.parent}, or copy the file to a folder of your own.")

    for folder in folders or []:
        if not folder.is_dir():
            raise Usage(f"--library {folder}: there is no such folder; name one that holds kinds.")
    return Library(library_folders(spec, folders or []))


def read_document(spec: Path, settings: list[str] | None) -> Mapping:
    """The spec with its settings."""
    from gaitsim.spec.inheritance import split_setting
    from gaitsim.spec.resolve import read_spec
    from gaitsim.study.foreign import refuse_foreign

    refuse_foreign(spec)
    return read_spec(spec, [split_setting(text) for text in settings or []])


def read_model(spec: Path, settings: list[str] | None, folders: list[Path] | None) -> Model:
    """The resolved model of a spec."""
    from gaitsim.spec.resolve import resolve

    return resolve(read_document(spec, settings), open_library(spec, folders), spec.stem)
