"""The results in a folder as rows, which can be filtered and sorted."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import date
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from gaitsim.errors import Usage
from gaitsim.results.bundle import COMPONENTS
from gaitsim.results.manifest import BadResult, recorded_manifest
from gaitsim.results.notes import notes_of
from gaitsim.whole import PARTIAL

_CHOICES = {"kind": ("run", "optimize"), "status": ("complete", "interrupted", "running", "damaged")}
Row = Mapping[str, Any]


def _number(key: str) -> Callable[[Row], float]:
    """A sort key that puts rows without the number last."""
    return lambda row: math.inf if row[key] is None else row[key]


ORDERS: Mapping[str, Callable[[Row], Any]] = {
    "created": lambda row: str(row["created"]),
    "name": lambda row: (str(row["name"]), str(row["created"])),
    "score": _number("best_score"),
    "evaluations": _number("evaluations"),
}


@dataclass(frozen=True)
class Filter:
    """The results that are wanted; None accepts all.

    Attributes:
        name: A pattern for the name of the spec.
        since: A day such as 2026-11-22.
        uses: A component.
        noted: A text in the notes.
    """

    name: str | None = None
    kind: str | None = None
    status: str | None = None
    since: str | None = None
    uses: str | None = None
    noted: str | None = None

    def __post_init__(self) -> None:
        """Check the words of the filter.

        Raises:
            Usage: No result can have such a word.
        """
        for option, choices in _CHOICES.items():
            value = getattr(self, option)
            if value is not None and value not in choices:
                raise Usage(f"--{option} {value}: write {' or '.join(choices)}.")
        if self.since is not None:
            try:
                date.fromisoformat(self.since)
            except ValueError as error:
                raise Usage(f"--since {self.since}: this is not a day; write one such as 2026-11-22.") from error
        if self.uses is not None and self.uses.count("/") != 1:
            raise Usage(f"--uses {self.uses}: write a component as KIND/NAME, such as muscle/geyer2003.")

    def keeps(self, row: Row) -> bool:
        """Whether the filter accepts a row."""
        return (
            (self.name is None or fnmatchcase(str(row["name"]), self.name))
            and self.kind in (None, row["kind"])
            and self.status in (None, row["status"])
            and (self.since is None or str(row["created"])[:10] >= self.since)
            and (self.uses is None or _uses(Path(row["result"]), self.uses))
            and (self.noted is None or self.noted.lower() in row["notes"].lower())
        )


def listed(root: Path, wanted: Filter, order: str) -> list[dict[str, Any]]:
    """The results in a folder. Results that are being created are left out.

    Args:
        root: The folder.
        wanted: The filter.
        order: A key of `ORDERS`.
    """
    folders = [path.parent for path in sorted(root.glob("*/manifest.json")) if path.parent.suffix != PARTIAL]
    return sorted((row for row in map(_row, folders) if wanted.keeps(row)), key=ORDERS[order])


def _row(folder: Path) -> dict[str, Any]:
    """The row of a result. A result whose manifest cannot be read is listed as damaged."""
    try:
        manifest = recorded_manifest(folder)
    except BadResult:
        manifest = {"kind": "?", "status": "damaged", "created": "", "name": folder.name}
    if manifest["kind"] == "optimize" and "best_score" not in manifest:
        manifest = {**manifest, **_so_far(folder)}
    keys = ("name", "kind", "status", "best_score", "evaluations", "created")
    return {"result": str(folder), **{key: manifest.get(key) for key in keys}, "notes": notes_of(folder)}


def _so_far(folder: Path) -> Row:
    """Where a search stands that has not come to its end: its last whole generation; nothing before the first."""
    from gaitsim.optimization.history import GENERATIONS

    try:
        with (folder / GENERATIONS).open(encoding="utf-8", newline="") as stream:
            *_, last = (row for row in csv.DictReader(stream) if row["failed"])
            return {"best_score": float(last["best"]), "evaluations": int(last["evaluations"])}
    except (OSError, ValueError, KeyError, TypeError, csv.Error):
        return {}


def _uses(folder: Path, reference: str) -> bool:
    return any((folder / COMPONENTS / f"{reference}{ending}").is_file() for ending in (".py", ".yaml"))
