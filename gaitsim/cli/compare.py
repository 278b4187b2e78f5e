"""gaitsim results compare: the differences of two models and of their runs."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, Results, Trust, opening

if TYPE_CHECKING:
    from gaitsim.results.difference import Change
    from gaitsim.study.comparison import Comparison, Pair

_LONGEST = 40  # letters of a cell; --json has all
_DIGITS = re.compile(r"\b\d+\.\d+(e[+-]?\d+)?\b")


def compare(
    first: Annotated[Path, typer.Argument(metavar="FIRST", help="A result folder or a spec.")],
    second: Annotated[
        Path, typer.Argument(metavar="SECOND", help="A result folder or a spec, compared with the first.")
    ],
    folder: Annotated[
        Path | None, typer.Option(metavar="FOLDER", help="Folder of the figures (default: in the second result).")
    ] = None,
    no_figures: Annotated[bool, typer.Option("--no-figures", help="Numbers only.")] = False,
    trust: Trust = False,
    library: Libraries = None,
    results: Results = None,
    json: Json = False,
) -> int:
    """Compare two results or specs: models, metrics and gaits.

    Models are compared part by part and value by value. Figures show both runs.

    Example: gaitsim results compare results/2026-11-22-hopping-3f9c results/2026-11-26-alice-41d0
    """
    from gaitsim.study.comparison import compared

    pair = [opening(path, None, library, trusted=trust, results=results) for path in (first, second)]
    found = compared(pair[0], pair[1], console.ConsoleListener(json), not no_figures, folder)
    if json:
        console.give_json(_data(found))
    else:
        _tell(found)
    return found.products.exit_code


def _tell(found: Comparison) -> None:
    from gaitsim.results.difference import KINDS, counted

    if found.changes:
        rows = [(c.what, c.where, *_cells(c.first, c.second)) for c in found.changes]
        console.give_table(["differs", "where", *found.labels], rows, "Models")
        console.give("; ".join(f"{KINDS[what]}: {count}" for what, count in counted(found.changes).items()))
    else:
        console.give("the models are the same, value by value, and so is the code of their components")
    for title, pairs in (("Metrics", found.metrics), ("Gait: means over the strides of both legs", found.gait)):
        if pairs:
            console.give("")
            console.give_table(
                [title.partition(":")[0].lower(), *found.labels, "difference", "%", "unit"], _rows(pairs), title
            )
    figures = found.products.figures
    if figures:
        console.give(f"{len(figures)} figure{'s' if len(figures) > 1 else ''} in {found.products.folder / 'figures'}")


def _cells(*texts: str) -> list[str]:
    """Two texts for a table: numbers with six digits, or with all digits if they would look equal."""
    short = [_DIGITS.sub(lambda found: f"{float(found[0]):.6g}", text) for text in texts]
    chosen = short if short[0] != short[1] else texts
    return [
        text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..." for text in (text or "-" for text in chosen)
    ]


def _rows(pairs: Sequence[Pair]) -> list[tuple[str, ...]]:
    return [
        (p.name, *(console.formatted(value) for value in (p.first, p.second, p.difference, p.percent)), p.unit)
        for p in pairs
    ]


def _data(found: Comparison) -> dict[str, Any]:
    def of(pairs: Sequence[Pair]) -> list[dict[str, Any]]:
        return [{**asdict(pair), "difference": pair.difference, "percent": pair.percent} for pair in pairs]

    changes: list[Change] = list(found.changes)
    return {
        "first": str(found.replays[0].path),
        "second": str(found.replays[1].path),
        "changes": [asdict(change) for change in changes],
        "metrics": of(found.metrics),
        "gait": of(found.gait),
        "figures": [str(path) for path in found.products.figures],
    }
