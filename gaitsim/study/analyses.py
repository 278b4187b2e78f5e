"""Results or specs run once more, and what is drawn, filmed and written of them."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from gaitsim.errors import GaitsimError, SimulationFailed, Usage
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
class Wanted:
    """What is made of runs that are looked at.

    Attributes:
        plot: Patterns of signals, or muscles.
        against: A signal that they are drawn against, instead of time.
        return_map: Signals whose maxima are drawn over the maxima before.
        export: Formats of all signals, such as sto.
        every: Of exports, one instant in such a time as '10 ms'.
        from_time, to_time: What is looked at, such as '2 s'.
        video: None makes one unless `only`.
        gif, speed, fps, size, scopes, view: Of the video; size as '1280x720'.
        formats: Of figures.
        only: No default figures, video or report.
        folder: Where all goes; None for inside the result.
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
        """Whether there is a video."""
        return (not self.only or self.gif or bool(self.scopes)) if self.video is None else self.video


@dataclass(frozen=True)
class Analysis:
    """Runs that were looked at, and what was made of them."""

    replays: Sequence[Replay]
    products: Products

    def __repr__(self) -> str:
        return f"<Analysis of {len(self.replays)} runs: {len(self.products.figures)} figures>"


def analyzed(openings: Sequence[Opening], candidates: Sequence[str], wanted: Wanted, listener: Listener) -> Analysis:
    """Run results or specs once more, and make what is wanted of them.

    What cannot be made is in the products' `faults`; the rest is made.

    Args:
        candidates: Of each result.

    Raises:
        GaitsimError: Nothing can be looked at, or the folder cannot be written.
    """
    from gaitsim.analysis.report.figures import missing

    if wanted.against is not None and not wanted.plot:
        raise Usage(f"--against {wanted.against}: name what is drawn against it, such as --plot '*.force'.")
    window = seconds_of("--from-time", wanted.from_time), seconds_of("--to-time", wanted.to_time)
    spacing = seconds_of("--every", wanted.every)
    products = Products(Path(), listener=listener)
    runs = _opened(openings, candidates, products)
    products.folder = writable(wanted.folder or _default_folder(runs))
    with listener.waiting("running again"):
        replays = _replayed(runs, window, products)
    against = [wanted.against] if wanted.against else []
    _say_lacking(replays, [*wanted.plot, *wanted.return_map, *against], listener)
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
    """Path, label and source of each run; what cannot be opened is said.

    Raises:
        GaitsimError: Nothing can be.
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
    """The runs, as far as they are looked at.

    Raises:
        GaitsimError: None has an instant.
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
        Usage: Nothing is in the window.
    """
    if not replay.times.size:
        raise SimulationFailed(f"{replay.label}: nothing to look at; the run {replay.ending}")
    if window == (None, None):
        return replay
    part = replay.between(*window)
    if not part.times.size:
        begin, end = window
        wanted = f"from {begin or 0:g} s" + (f" to {end:g} s" if end is not None else "")
        raise Usage(f"{replay.label}: nothing to look at {wanted}; the run goes from 0 s to {replay.times[-1]:g} s.")
    return part


def _asked(
    replays: list[Replay], plot: Sequence[str], against: str | None, return_maps: Sequence[str]
) -> list[Callable[[], list[Drawing]]]:
    """What --plot and --return-map draw; --plot of a muscle is its own figures."""
    from gaitsim.analysis.muscles import figures as muscles
    from gaitsim.analysis.signals import plots

    def map_of(text: str) -> list[Drawing]:
        return [plots.return_map(replays, text)]

    def over_time(text: str) -> list[Drawing]:
        own = [(replay, address) for replay in replays for address in muscles.matching_muscles(replay, text)]
        if own and len(plots.lacking(replays, text)) == len(replays):
            return [drawing for replay, address in own for drawing in muscles.figures_of(replay, address)]
        return plots.against_time(replays, text)

    drawn = [partial(over_time, text) for text in plot if against is None]
    drawn += [partial(plots.against_signal, replays, text, against) for text in plot if against is not None]
    return [*drawn, *(partial(map_of, text) for text in return_maps)]


def _say_lacking(replays: list[Replay], words: Sequence[str], listener: Listener) -> None:
    """Say which runs lack a signal that others have."""
    from gaitsim.analysis.signals.plots import lacking

    for text in words:
        without = lacking(replays, text)
        if 0 < len(without) < len(replays):
            listener.say(f"{text}: {', '.join(without)} has no such signal")


def _default_folder(runs: list[tuple[Path, str, Opened]]) -> Path:
    """Inside the result, or below analysis/ for a spec; a comparison has a folder of its own there."""
    path, _, opened = runs[0]
    own = path if opened.manifest else Path("analysis") / opened.name
    return own if len(runs) == 1 else own / "comparison"


def writable(folder: Path) -> Path:
    """The folder, which can be written to.

    Raises:
        CannotSave: The folder cannot be written.
    """
    from gaitsim.results.store import CannotSave

    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError as error:
        reason = error.strerror or str(error)
        raise CannotSave(f"{folder}: nothing can be written here ({reason}); choose another --folder.") from error


def _video_options(wanted: Wanted) -> VideoOptions:
    """Read the options of the video.

    Raises:
        Usage: The request does not fit.
    """
    from gaitsim.animation.video import VideoOptions, read_size

    size = read_size(wanted.size) if wanted.size else None
    return VideoOptions(wanted.speed, wanted.fps, size, wanted.scopes, view=wanted.view)
