"""The result of a run, a study or draws. Each run is stored when it ends."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import Any

from gaitsim.model import Model
from gaitsim.optimization.draws import Draws
from gaitsim.results.bundle import Bundle
from gaitsim.results.lock import Lock
from gaitsim.results.manifest import new_manifest, write_manifest
from gaitsim.results.provenance import changes_file
from gaitsim.results.readme import readme
from gaitsim.results.rows import row_words
from gaitsim.results.store import CannotSave, create_result, finish, row_data
from gaitsim.results.tuned import problem_of
from gaitsim.simulation.outcome import Outcome
from gaitsim.units import with_unit
from gaitsim.whole import write_whole

_ROWS = "evaluations.jsonl"
_MOVE = "make room or rights there, name another folder with --results, or use --no-save"
_TOLD = 20  # runs that the README lists


class Record:
    """A result folder that is created with its first run. Runs that were saved stay, whatever follows.

    Args:
        model: The first one that is run.
        xml: Its MJCF.
        place: The folder of its spec.
        draws: Around the model's starts, if the runs are these.
        more: What else the manifest says.
    """

    def __init__(
        self,
        root: Path,
        bundle: Bundle,
        model: Model,
        xml: str,
        mode: str,
        place: Path,
        draws: Draws | None = None,
        more: Mapping[str, Any] | None = None,
    ) -> None:
        self.folder: Path | None = None
        self._root, self._bundle, self._model, self._xml, self._draws = root, bundle, model, xml, draws
        self._manifest = new_manifest("run", bundle, mode, place, notices=list(model.notices), **(more or {}))
        if draws:
            self._manifest["draws"] = asdict(draws)
        self._samples = draws.values(problem_of(model)) if draws else []
        self._changes = changes_file(place)
        self._rows: list[dict[str, Any]] = []
        self._held = ExitStack()

    def go_on(self, folder: Path, rows: list[dict[str, Any]], manifest: dict[str, Any]) -> None:
        """Continue the result in a folder.

        Raises:
            CannotSave: The folder cannot be written.
            Locked: Another process writes this result.
        """
        self._held.enter_context(Lock(folder))
        self.folder, self._rows, self._manifest = folder, rows, manifest | {"status": "running"}
        try:
            write_whole(folder / _ROWS, "".join(_line(row) for row in rows))
            write_manifest(folder, self._manifest)
        except OSError as error:
            raise self._cannot(error) from error

    def add(self, settings: Mapping[str, str], outcome: Outcome, more: Mapping[str, Any] | None = None) -> None:
        """Save one run, with further data.

        Args:
            settings: What the run sets, as text by address.
            outcome: Its outcome.
            more: Further data of its row.

        Raises:
            CannotSave: The folder cannot be written. The runs before are unchanged.
        """
        row = row_data(settings, outcome) | dict(more or {})
        if self._draws:
            row |= {"draw": len(self._rows) + 1, "values": self._samples[len(self._rows)]}
        line = _line(row)
        if self.folder is None:
            more = {_ROWS: line, "README.md": readme(self._manifest, [], ""), **self._changes}
            self.folder = create_result(self._root, self._bundle, self._model, self._xml, self._manifest, more, _MOVE)
            self._held.enter_context(Lock(self.folder))
        else:
            self._append(line)
        self._rows.append(row)

    def arrange(self, place: Callable[[Mapping[str, Any]], int]) -> None:
        """Sort the runs.

        Args:
            place: The position of a run, from its row.

        Raises:
            CannotSave: The folder cannot be written.
        """
        if self.folder is None:
            return
        self._rows.sort(key=place)
        try:
            write_whole(self.folder / _ROWS, "".join(_line(row) for row in self._rows))
        except OSError as error:
            raise self._cannot(error) from error

    def close(self, status: str) -> None:
        """Store how the result ended: complete or interrupted.

        Raises:
            CannotSave: The folder cannot be written.
        """
        if self.folder is None:
            return
        with self._held:
            try:
                finish(self.folder, self._manifest | {"status": status}, self._headline())
            except OSError as error:
                raise self._cannot(error) from error

    def _append(self, line: str) -> None:
        """Write a line completely or not at all."""
        assert self.folder is not None
        path = self.folder / _ROWS
        try:
            size = path.stat().st_size
            try:
                with path.open("a", encoding="utf-8") as file:
                    file.write(line)
            except OSError:
                os.truncate(path, size)
                raise
        except OSError as error:
            raise self._cannot(error) from error

    def _cannot(self, error: OSError) -> CannotSave:
        count = f"the first {len(self._rows)} runs are" if len(self._rows) > 1 else "the first run is"
        return CannotSave(f"{self.folder}: the result cannot be saved ({error.strerror or error}); {count} in it.")

    def _headline(self) -> list[str]:
        """The first runs in one line each, and the number of draws that completed."""
        tally = []
        if self._draws:
            done = sum(row["status"] == "completed" for row in self._rows)
            within = f"within {100 * self._draws.within:g} % completed (seed {self._draws.seed})"
            tally = [f"{done} of {self._draws.count} draws {within}"]
        return [*tally, *(_row_text(row, self._model.metrics) for row in self._rows[:_TOLD])]


def _line(row: Mapping[str, Any]) -> str:
    return json.dumps(row, allow_nan=False) + "\n"


def _row_text(row: Mapping[str, Any], units: Mapping[str, str]) -> str:
    label = row_words(row)
    found = {name: math.nan if v is None else v for name, v in row["metrics"].items()}
    numbers = ", ".join(f"{name} {with_unit(f'{v:.5g}', units.get(name, '1'))}" for name, v in found.items())
    return f"{label + ': ' if label else ''}{row['status']}{': ' + numbers if numbers else ''}"
