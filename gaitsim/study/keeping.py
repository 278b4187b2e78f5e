"""What is kept of runs; what stands in the way of that is told after the runs themselves."""

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


class Keeping:
    """Keeps runs in a result folder below `root`, or nowhere if there is none."""

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
        """Where the runs are, if they are all there."""
        return self._record.folder if self._record and not self.error else None

    def add(self, settings: Mapping[str, str], outcome: Outcome, more: Mapping[str, Any] | None = None) -> None:
        """Keep one run, and what else there is to say of it, unless one before it could not be kept."""
        if self._root and not self.error:
            with self.noting():
                self._record = self._record or self._begun(self._root)
                self._record.add(settings, outcome, *([more] if more else []))

    def go_on(self, folder: Path, rows: list[dict[str, Any]]) -> None:
        """Keep the runs that come in a folder that has some.

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
        """Put the runs that were kept in the order of their places, whatever order they came in."""
        if self._record and not self.error:
            with self.noting():
                self._record.arrange(place)

    @contextmanager
    def noting(self) -> Iterator[None]:
        """What goes wrong in the block is told at the end; the first of it."""
        try:
            yield
        except GaitsimError as error:
            self.error = self.error or error

    def close(self, status: str = "complete") -> None:
        """No run comes any more."""
        if self._record:
            with self.noting():
                self._record.close("interrupted" if self.error else status)
