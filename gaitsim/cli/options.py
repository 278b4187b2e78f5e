"""Options and arguments that several commands share."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from gaitsim.study.opening import Opening, open_library


def complete_references(incomplete: str) -> list[str]:
    """Complete components in the shell."""
    return [reference for reference in open_library(None, ()).references() if reference.startswith(incomplete)]


def complete_kinds(incomplete: str) -> list[str]:
    """Complete kinds of components in the shell."""
    return sorted(kind for kind in open_library(None, ()).kinds() if kind.startswith(incomplete))


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


Results = Annotated[
    Path | None,
    typer.Option(
        "--results", metavar="FOLDER", help="Folder of the results (default: $GAITSIM_RESULTS, or else results)."
    ),
]


class ModeName(StrEnum):
    """The two ways of running a model."""

    rapid = "rapid"
    normal = "normal"


def opening(
    path: Path,
    settings: list[str] | None,
    folders: list[Path] | None,
    tuned: bool = True,
    trusted: bool = False,
    candidate: str | None = None,
    results: Path | None = None,
) -> Opening:
    """What a command opens, from its options.

    Args:
        results: The folder in which names of results are looked up.
    """
    from gaitsim.results.manifest import result_named

    named = result_named(path, results)
    return Opening(named, tuple(settings or ()), tuple(folders or ()), tuned, trusted, candidate, results)
