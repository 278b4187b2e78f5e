"""The products of an analysis: figures, exports, a video, a report. If one cannot be made, the others still are."""

from __future__ import annotations

import errno
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from gaitsim.errors import ExitCode, GaitsimError
from gaitsim.exchange.formats import FORMATS, Export
from gaitsim.results.store import CannotSave
from gaitsim.study.listening import Listener, LogListener

if TYPE_CHECKING:
    from gaitsim.analysis.drawings.drawing import Drawing, Figures
    from gaitsim.analysis.replays.replay import Replay
    from gaitsim.animation.video import VideoOptions

T = TypeVar("T")


@dataclass
class Products:
    """The files that were made in a folder, and what could not be made.

    Attributes:
        faults: What the user can correct.
        lacks: What the model or this machine lacks; this is not a failure.
        listener: Receives what could not be made, and progress.
    """

    folder: Path
    figures: list[Path] = field(default_factory=list)
    exports: list[Path] = field(default_factory=list)
    drawings: list[Drawing] = field(default_factory=list)
    video: Path | None = None
    report: Path | None = None
    faults: list[GaitsimError] = field(default_factory=list)
    lacks: list[str] = field(default_factory=list)
    listener: Listener = field(default_factory=LogListener)

    @property
    def exit_code(self) -> int:
        """The exit code of the first fault."""
        return self.faults[0].exit_code if self.faults else ExitCode.OK

    def refuse(self, error: GaitsimError) -> None:
        """Report what could not be made, and continue."""
        self.listener.say_error(error)
        self.faults.append(error)

    def remark(self, remarks: Sequence[str]) -> None:
        """Report something that is missing and is not a failure."""
        for word in remarks:
            self.listener.say(word)
            self.lacks.append(word)

    def refuse_if_others(self, error: GaitsimError, count: int) -> None:
        """Report that one of several runs cannot be analyzed. The error of an only run is raised."""
        if count > 1:
            self.listener.say_error(error)
        self.faults.append(error)

    def attempt(self, what: str, make: Callable[[], T]) -> T | None:
        """Make something. An error is reported, and the rest continues."""
        try:
            return make()
        except GaitsimError as error:
            self.refuse(error)
        except OSError as error:
            move = "free some space" if error.errno == errno.ENOSPC else "choose another --folder"
            reason = error.strerror or str(error)
            self.refuse(CannotSave(f"{self.folder}: {what} cannot be written ({reason}); {move}."))
        return None

    def draw(self, makers: Sequence[Callable[[], list[Drawing]]], formats: Sequence[str]) -> None:
        """Make figures and write them; each gets a name of its own."""
        from gaitsim.analysis.drawings.drawing import save

        taken: set[str] = set()
        report = self.listener.progress("figures")
        for k, maker in enumerate(makers, start=1):
            for drawing in self.attempt("a figure", maker) or []:
                named = _renamed(drawing, taken)
                self.drawings.append(named)
                where = self.folder / "figures"
                self.figures += self.attempt(f"the figure {named.name}", partial(save, [named], where, formats)) or []
            report(k, len(makers))

    def export(self, replays: Sequence[Replay], formats: Sequence[str], every: float | None) -> None:
        """Write the signals of each run in each format of `FORMATS` that is named.

        Args:
            every: The time between two instants in s; None for every step.
        """
        for replay in replays:
            for ending in formats:
                path = self.folder / "exports" / f"{_plain(replay.label)}.{ending}"
                if self.attempt(f"the export {path.name}", partial(_write, replay, path, every)):
                    self.exports.append(path)

    def film(self, replay: Replay, options: VideoOptions, ending: str) -> None:
        """Write the video. If this machine cannot draw one, a line says so."""
        from gaitsim.animation import NoOpenGL
        from gaitsim.animation.video import record

        def make() -> Path | None:
            try:
                return record(replay, self.folder / f"video.{ending}", options, self.listener.progress("video"))
            except NoOpenGL as error:
                self.remark([str(error)])
                return None

        self.video = self.attempt("the video", make)

    def write_report(self, replays: Sequence[Replay]) -> None:
        """Write the report, a page with everything."""
        from gaitsim.analysis.report.report import write

        path = self.folder / "report.html"
        remarks = [*self.lacks, *(str(error) for error in self.faults)]
        self.report = self.attempt("the report", partial(write, path, replays, self.drawings, self.video, remarks))


def default_figures(replays: Sequence[Replay]) -> list[Callable[[], list[Drawing]]]:
    """The default figures: several runs over one another, and the figures of each run."""
    from gaitsim.analysis.report.figures import FIGURES

    def of_run(figures: Figures, replay: Replay) -> Callable[[], list[Drawing]]:
        return lambda: [_of_run(drawing, replay, len(replays) > 1) for drawing in figures(replay)]

    over = overlaid_figures(replays) if len(replays) > 1 else []
    return [*over, *(of_run(figures, replay) for replay in replays for figures in FIGURES)]


def overlaid_figures(replays: Sequence[Replay]) -> list[Callable[[], list[Drawing]]]:
    """The figures of several runs over one another."""
    from gaitsim.analysis.report.figures import OVERLAYS

    return [partial(overlay, replays) for overlay in OVERLAYS]


def _of_run(drawing: Drawing, replay: Replay, several: bool) -> Drawing:
    if not several:
        return drawing
    label = _plain(replay.label)
    return replace(drawing, name=f"{label}.{drawing.name}", title=f"{drawing.title}, {replay.label}")


def _renamed(drawing: Drawing, taken: set[str]) -> Drawing:
    """The drawing with a name that no other drawing has."""
    name, number = drawing.name, 1
    while name.lower() in taken:
        number += 1
        name = f"{drawing.name}_{number}"
    taken.add(name.lower())
    return replace(drawing, name=name)


def _write(replay: Replay, path: Path, every: float | None) -> Path:
    """Write all signals of a run to a file.

    Raises:
        OSError: The file cannot be read or written.
        Usage: The request does not fit.
    """
    from gaitsim.analysis.replays.replay import dataset

    if every is not None:
        replay = replay.every(every)
    made = Export(replay.name, replay.trajectory, partial(dataset, replay))
    FORMATS[path.suffix.removeprefix(".")].write(path, made)
    return path


def _plain(label: str) -> str:
    """A label as part of a file name."""
    return "".join(letter if letter.isalnum() or letter in "-_." else "_" for letter in label)
