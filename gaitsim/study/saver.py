"""Saving of runs. What prevents it is reported after the runs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.errors import GaitsimError

if TYPE_CHECKING:
    from gaitsim.model import Model
    from gaitsim.optimization.draws import Draws
    from gaitsim.results.record import Record
    from gaitsim.simulation.outcome import Outcome
    from gaitsim.study.opened import Opened


class RunSaver:
    """Saves runs in a result folder in `root`, or nowhere without `root`."""

    def __init__(
        self,
        root: Path | None,
        opened: Opened,
        models: Sequence[Model],
        mode: str,
        draws: Draws | None = None,
        more: Mapping[str, Any] | None = None,
    ) -> None:
        self.error: GaitsimError | None = None
        self._more = more
        self._root, self._opened, self._models, self._mode, self._draws = root, opened, models, mode, draws
        self._record: Record | None = None

    @property
    def folder(self) -> Path | None:
        """The result folder; None if a run is not saved."""
        return self._record.folder if self._record and not self.error else None

    def add(self, settings: Mapping[str, str], outcome: Outcome, more: Mapping[str, Any] | None = None) -> None:
        """Save one run with further data, unless an earlier one could not be saved."""
        if self._root and not self.error:
            with self.errors_kept():
                self._record = self._record or self._begun(self._root)
                self._record.add(settings, outcome, *([more] if more else []))

    def go_on(self, folder: Path, rows: list[dict[str, Any]]) -> None:
        """Continue a result that has some runs.

        Raises:
            CannotSave: The folder cannot be written.
            Locked: Another process writes this result.
        """
        self._root = folder.parent
        self._record = self._begun(self._root)
        self._record.go_on(folder, rows, dict(self._opened.manifest))

    def _begun(self, root: Path) -> Record:
        from gaitsim.compiler.mjcf import assemble
        from gaitsim.results.record import Record

        model = self._models[0]
        xml = assemble(model, model.values()).xml
        bundle, place = self._opened.bundle(self._models), self._opened.place
        return Record(root, bundle, model, xml, self._mode, place, self._draws, self._more)

    def arrange(self, place: Callable[[Mapping[str, Any]], int]) -> None:
        """Sort the saved runs."""
        if self._record and not self.error:
            with self.errors_kept():
                self._record.arrange(place)

    @contextmanager
    def errors_kept(self) -> Iterator[None]:
        """Catch errors of saving in the block. The first one is reported at the end."""
        try:
            yield
        except GaitsimError as error:
            self.error = self.error or error

    def close(self, status: str = "complete") -> None:
        """End the result; no more runs follow."""
        if self._record:
            with self.errors_kept():
                self._record.close("interrupted" if self.error else status)
