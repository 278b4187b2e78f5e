"""Analyses: results or specs are run once more, and figures, films, exports and reports are made of them."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from gaitsim.errors import GaitsimError, SimulationFailed, Usage
from gaitsim.folders import analysis_folder
from gaitsim.study.products import Products, default_figures
from gaitsim.study.times import seconds_of

if TYPE_CHECKING:
    from gaitsim.analysis.drawings.drawing import Drawing
    from gaitsim.analysis.replays.replay import Replay
    from gaitsim.animation.video import VideoOptions
    from gaitsim.study.listening import Listener
    from gaitsim.study.opened import Opened
    from gaitsim.study.opening import Opening


@dataclass(frozen=True)
class AnalysisRequest:
    """What an analysis makes.

    Attributes:
        plot: Patterns of signals, or muscles.
        against: The signal on the x axis, instead of time.
        return_map: Signals whose maxima are drawn over the previous ones.
        export: Formats of all signals, such as sto.
        every: The time between exported instants, such as '10 ms'.
        from_time, to_time: The part of the run that is analyzed, such as '2 s'.
        video: Whether to make a video; None makes one unless `only`.
        gif, speed, fps, size, scopes, view: Options of the video; size is of the form '1280x720'.
        formats: Formats of the figures.
        only: Whether to leave out the default figures, the video and the report.
        folder: The output folder; None for the result.
    """

    plot: tuple[str, ...] = ()
    against: str | None = None
    return_map: tuple[str, ...] = ()
    export: tuple[str, ...] = ()
    every: str | None = None
    from_time: str | None = None
    to_time: str | None = None
    video: bool | None = None
    gif: bool = False
    speed: float = 1.0
    fps: float | None = None
    size: str | None = None
    scopes: tuple[str, ...] = ()
    view: str = "side"
    formats: tuple[str, ...] = ("png",)
    only: bool = False
    folder: Path | None = None

    @property
    def filmed(self) -> bool:
        """Whether a video is made."""
        return (not self.only or self.gif or bool(self.scopes)) if self.video is None else self.video


@dataclass(frozen=True)
class Analysis:
    """The runs that were analyzed, and the files that were made."""

    replays: Sequence[Replay]
    products: Products

    def __repr__(self) -> str:
        return f"<Analysis of {len(self.replays)} runs: {len(self.products.figures)} figures>"


def analyzed(
    openings: Sequence[Opening], candidates: Sequence[str], wanted: AnalysisRequest, listener: Listener
) -> Analysis:
    """Run results or specs once more, and make what is wanted of them.

    What cannot be made is reported in the products' `faults`; everything else is made.

    Args:
        openings: The results and specs.
        candidates: The candidates of each result.
        wanted: What to make.
        listener: Receives progress and notices.

    Raises:
        GaitsimError: No run can be analyzed, or the folder cannot be written.
    """
    from gaitsim.analysis.report.figures import missing

    if wanted.against is not None and not wanted.plot:
        raise Usage(f"--against {wanted.against}: name what is drawn against it, such as --plot '*.force'.")
    window = seconds_of("--from-time", wanted.from_time), seconds_of("--to-time", wanted.to_time)
    spacing = seconds_of("--every", wanted.every)
    products = Products(Path(), listener=listener)
    runs = _opened(openings, candidates, products)
    products.folder = writable(wanted.folder or _default_folder(runs, openings[0].results))
    with listener.waiting("running again"):
        replays = _replayed(runs, window, products)
    against = [wanted.against] if wanted.against else []
    _say_missing(replays, [*wanted.plot, *wanted.return_map, *against], listener)
    asked = _asked(replays, wanted.plot, wanted.against, wanted.return_map)
    products.draw([*asked, *([] if wanted.only else default_figures(replays))], wanted.formats)
    products.export(replays, wanted.export, spacing)
    if wanted.filmed:
        if len(replays) > 1:
            products.remark([f"the video shows {replays[0].label}"])
        products.film(replays[0], _video_options(wanted), "gif" if wanted.gif else "mp4")
    if not wanted.only:
        products.remark([word for replay in replays for word in missing(replay)])
        products.write_report(replays)
    return Analysis(replays, products)


def _opened(
    openings: Sequence[Opening], candidates: Sequence[str], products: Products
) -> list[tuple[Path, str, Opened]]:
    """Path, label and opened spec or result of each run. Those that cannot be opened are reported.

    Raises:
        GaitsimError: None can be opened.
    """
    found: list[tuple[Path, str, Opened]] = []
    for opening in openings:
        path, result = opening.path, opening.names_result
        usual: list[str | None] = ["best" if result else None]
        for which in candidates or usual:
            name = path.name if result else path.stem
            label = f"{name} {which}" if len(candidates) > 1 else name
            if label in (known for _, known, _ in found):
                label = f"{path} {which}" if which else str(path)
            try:
                found.append((path, label, replace(opening, candidate=which).open()))
            except GaitsimError as error:
                products.refuse_if_others(error, len(openings) * len(candidates or [None]))
    if not found:
        raise products.faults[0]
    return found


def _replayed(
    runs: list[tuple[Path, str, Opened]], window: tuple[float | None, float | None], products: Products
) -> list[Replay]:
    """The runs within the window of time. Those that cannot be analyzed are reported.

    Raises:
        GaitsimError: No run has an instant there.
    """
    from gaitsim.study.replays import replay_of

    found: list[Replay] = []
    for path, label, opened in runs:
        try:
            found.append(_looked_at(replay_of(opened, path, label), window))
        except GaitsimError as error:
            products.refuse_if_others(error, len(runs))
    if not found:
        raise products.faults[0]
    for notice in dict.fromkeys(notice for replay in found for notice in replay.notices):
        products.listener.say(notice)
    for replay in found:
        if replay.ending:
            products.listener.say(f"{replay.label}: {replay.ending}")
    return found


def _looked_at(replay: Replay, window: tuple[float | None, float | None]) -> Replay:
    """Cut a run to the window of time.

    Raises:
        SimulationFailed: The run failed before its first instant.
        Usage: The window has no instant.
    """
    if not replay.times.size:
        raise SimulationFailed(f"{replay.label}: nothing to analyze; the run {replay.ending}")
    if window == (None, None):
        return replay
    part = replay.between(*window)
    if not part.times.size:
        begin, end = window
        wanted = f"from {begin or 0:g} s" + (f" to {end:g} s" if end is not None else "")
        raise Usage(f"{replay.label}: nothing to analyze {wanted}; the run goes from 0 s to {replay.times[-1]:g} s.")
    return part


def _asked(
    replays: list[Replay], plot: Sequence[str], against: str | None, return_maps: Sequence[str]
) -> list[Callable[[], list[Drawing]]]:
    """Functions that make the figures of --plot and --return-map. For a muscle, --plot makes its own figures."""
    from gaitsim.analysis.muscles import figures as muscles
    from gaitsim.analysis.signals import plots, return_map_figure
    from gaitsim.analysis.signals.selection import runs_without

    def map_of(text: str) -> list[Drawing]:
        return [return_map_figure.return_map(replays, text)]

    def over_time(text: str) -> list[Drawing]:
        own = [(replay, address) for replay in replays for address in muscles.matching_muscles(replay, text)]
        if own and len(runs_without(replays, text)) == len(replays):
            return [drawing for replay, address in own for drawing in muscles.figures_of(replay, address)]
        return plots.against_time(replays, text)

    drawings = [partial(over_time, text) for text in plot if against is None]
    drawings += [partial(plots.against_signal, replays, text, against) for text in plot if against is not None]
    return [*drawings, *(partial(map_of, text) for text in return_maps)]


def _say_missing(replays: list[Replay], texts: Sequence[str], listener: Listener) -> None:
    """Report the runs that lack a signal which others have."""
    from gaitsim.analysis.signals.selection import runs_without

    for text in texts:
        without = runs_without(replays, text)
        if 0 < len(without) < len(replays):
            listener.say(f"{text}: {', '.join(without)} has no such signal")


def _default_folder(runs: list[tuple[Path, str, Opened]], results: Path | None) -> Path:
    """The output folder: inside the result, or for a spec in `analysis_folder`. A comparison has its own in it."""
    path, _, opened = runs[0]
    own = path if opened.manifest else analysis_folder(results) / opened.name
    return own if len(runs) == 1 else own / "comparison"


def writable(folder: Path) -> Path:
    """Create a folder and check that it can be written.

    Raises:
        CannotSave: It cannot.
    """
    from gaitsim.results.store import CannotSave

    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError as error:
        reason = error.strerror or str(error)
        raise CannotSave(f"{folder}: nothing can be written here ({reason}); choose another --folder.") from error


def _video_options(wanted: AnalysisRequest) -> VideoOptions:
    """Read the options of the video.

    Raises:
        Usage: The request does not fit.
    """
    from gaitsim.animation.video import VideoOptions, read_size

    size = read_size(wanted.size) if wanted.size else None
    return VideoOptions(wanted.speed, wanted.fps, size, wanted.scopes, view=wanted.view)
