"""gaitsim analyze: run a result or a spec once more, and look at everything inside it."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, Set, Trust, opening
from gaitsim.errors import GaitsimError, SimulationFailed, Usage, alternatives
from gaitsim.exchange.formats import FORMATS

if TYPE_CHECKING:
    from gaitsim.analysis.drawings.drawing import Drawing
    from gaitsim.analysis.replays.replay import Replay
    from gaitsim.animation.video import VideoOptions
    from gaitsim.study.products import Products
    from gaitsim.study.source import Source


Export = StrEnum("Export", {ending: ending for ending in FORMATS})  # type: ignore[misc]  # one declaration of formats
_EXPORTS = alternatives(format.words for format in FORMATS.values())


class Format(StrEnum):
    """Formats of figures."""

    png = "png"
    svg = "svg"
    pdf = "pdf"


def analyze(
    paths: Annotated[
        list[Path],
        typer.Argument(metavar="RESULT...", help="Result folders or specs; several are drawn over one another."),
    ],
    plot: Annotated[
        list[str] | None,
        typer.Option(metavar="PATTERN", help="Signals to draw, such as 'leg_*.soleus.force', or a muscle; repeatable."),
    ] = None,
    against: Annotated[
        str | None, typer.Option(metavar="SIGNAL", help="Signal on the x axis of --plot, instead of time.")
    ] = None,
    return_map: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SIGNAL", help="Draw each maximum of a signal over the one before; for a measure, of its input."
        ),
    ] = None,
    candidate: Annotated[
        list[str] | None,
        typer.Option(
            metavar="WHICH", help="best, a rank, or GENERATION:INDEX; the number of a run for a study; repeatable."
        ),
    ] = None,
    export: Annotated[
        list[Export] | None, typer.Option(help=f"Write all signals as {_EXPORTS}; repeatable.")
    ] = None,
    every: Annotated[
        str | None,
        typer.Option(metavar="TIME", help="Time between exported instants, such as '10 ms' (default: every step)."),
    ] = None,
    from_time: Annotated[
        str | None, typer.Option(metavar="TIME", help="Start of the time that is shown, such as '2 s'.")
    ] = None,
    to_time: Annotated[str | None, typer.Option(metavar="TIME", help="End of the time that is shown.")] = None,
    video: Annotated[
        bool | None, typer.Option("--video/--no-video", help="Make a video.  [default: unless --only]")
    ] = None,
    gif: Annotated[bool, typer.Option("--gif", help="Make the video a GIF.")] = False,
    speed: Annotated[
        float, typer.Option(help="Speed of the video; 0.25 is slow motion at a quarter of real time.")
    ] = 1.0,
    fps: Annotated[float | None, typer.Option(help="Frames per second of the video.")] = None,
    size: Annotated[
        str | None, typer.Option(metavar="WxH", help="Size of the video in pixels, such as 1280x720.")
    ] = None,
    scopes: Annotated[
        list[str] | None, typer.Option(metavar="PATTERN", help="Signals to show beside the video; repeatable.")
    ] = None,
    formats: Annotated[list[Format] | None, typer.Option("--format", help="Format of the figures; repeatable.")] = None,
    only: Annotated[
        bool, typer.Option("--only", help="Make only what other options ask for: no default figures, video or report.")
    ] = False,
    folder: Annotated[Path | None, typer.Option(metavar="FOLDER", help="Output folder (default: the result).")] = None,
    start: Annotated[bool, typer.Option("--start", help="Ignore the tuned values beside the spec.")] = False,
    trust: Trust = False,
    settings: Set = None,
    library: Libraries = None,
    json: Json = False,
) -> int:
    """Make figures, a video, a report and exports of results.

    Examples:

    gaitsim analyze results/2026-11-22-hopping-3f9c

    gaitsim analyze specs/hopping_geyer2003.yaml --only --plot 'extensor.*' --from-time '2 s' --to-time '4 s'

    gaitsim analyze results/2026-11-22-hopping-3f9c --candidate best --candidate 0:0 --plot guide.position

    gaitsim analyze results/2026-11-22-hopping-3f9c --only --export sto --return-map guide.position
    """
    from gaitsim.analysis.report.figures import missing
    from gaitsim.study.products import Products, default_figures
    from gaitsim.study.times import seconds_of

    if against is not None and not plot:
        raise Usage(f"--against {against}: name what is drawn against it, such as --plot '*.force'.")
    window = seconds_of("--from-time", from_time), seconds_of("--to-time", to_time)
    spacing = seconds_of("--every", every)
    products = Products(Path(), listener=console.Talk(json))
    sources = _opened(paths, candidate, settings, library, start, trust, products)
    products.folder = _made(folder or _default_folder(sources))
    with console.waiting("running again", quiet=json):
        replays = _replayed(sources, window, products)
    _said_lacking(replays, [*(plot or []), *(return_map or []), *([against] if against else [])])
    asked = _asked(replays, plot or [], against, return_map or [])
    products.draw([*asked, *([] if only else default_figures(replays))], [f.value for f in formats or [Format.png]])
    products.export(replays, [ending.value for ending in export or []], spacing)
    if (not only or gif or scopes) if video is None else video:
        if len(replays) > 1:
            products.remark([f"the video shows {replays[0].label}"])
        products.film(replays[0], _video_options(speed, fps, size, scopes), "gif" if gif else "mp4")
    if not only:
        products.remark([word for replay in replays for word in missing(replay)])
        products.write_report(replays)
    _tell(replays, products, json)
    return products.exit_code


def _opened(
    paths: list[Path],
    candidates: list[str] | None,
    settings: list[str] | None,
    library: list[Path] | None,
    start: bool,
    trust: bool,
    products: Products,
) -> list[tuple[Path, str, Source]]:
    """Path, label and source of each run; what cannot be opened is said.

    Errors: GaitsimError if nothing can be.
    """
    from gaitsim.results.manifest import is_result


    found: list[tuple[Path, str, Source]] = []
    for path in paths:
        result = is_result(path)
        usual: list[str | None] = ["best" if result else None]
        for which in candidates or usual:
            name = path.name if result else path.stem
            label = f"{name} {which}" if candidates and len(candidates) > 1 else name
            if label in (known for _, known, _ in found):
                label = f"{path} {which}" if which else str(path)
            try:
                found.append((path, label, opening(path, settings, library, not start, trust, which).source()))
            except GaitsimError as error:
                products.refuse_if_others(error, len(paths) * len(candidates or [None]))
    if not found:
        raise products.faults[0]
    return found


def _replayed(
    sources: list[tuple[Path, str, Source]], window: tuple[float | None, float | None], products: Products
) -> list[Replay]:
    """The runs, as far as they are looked at. Errors: GaitsimError if none has an instant."""
    from gaitsim.study.replays import replay_of

    found: list[Replay] = []
    for path, label, source in sources:
        try:
            found.append(_looked_at(replay_of(source, path, label), window))
        except GaitsimError as error:
            products.refuse_if_others(error, len(sources))
    if not found:
        raise products.faults[0]
    for notice in dict.fromkeys(notice for replay in found for notice in replay.notices):
        console.say(notice)
    for replay in found:
        if replay.ending:
            console.say(f"{replay.label}: {replay.ending}")
    return found


def _looked_at(replay: Replay, window: tuple[float | None, float | None]) -> Replay:
    """Errors: SimulationFailed if the run failed before its first instant, Usage if nothing is in the window."""
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
    replays: list[Replay], plot: list[str], against: str | None, return_maps: list[str]
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


def _said_lacking(replays: list[Replay], words: list[str]) -> None:
    """Say which runs lack a signal that others have."""
    from gaitsim.analysis.signals.plots import lacking

    for text in words:
        without = lacking(replays, text)
        if 0 < len(without) < len(replays):
            console.say(f"{text}: {', '.join(without)} has no such signal")


def _default_folder(sources: list[tuple[Path, str, Source]]) -> Path:
    """Inside the result, or below analysis/ for a spec; a comparison has a folder of its own there."""
    path, _, source = sources[0]
    own = path if source.manifest else Path("analysis") / source.name
    return own if len(sources) == 1 else own / "comparison"


def _made(folder: Path) -> Path:
    """The folder, which can be written to. Errors: CannotSave."""
    from gaitsim.results.store import CannotSave

    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError as error:
        reason = error.strerror or str(error)
        raise CannotSave(f"{folder}: nothing can be written here ({reason}); choose another --folder.") from error


def _video_options(speed: float, fps: float | None, size: str | None, scopes: list[str] | None) -> VideoOptions:
    """Errors: Usage."""
    from gaitsim.animation.video import VideoOptions, read_size

    return VideoOptions(speed, fps, read_size(size) if size else None, tuple(scopes or ()))


def _tell(replays: list[Replay], products: Products, json: bool) -> None:
    """The measures and what was made: on stdout."""
    runs = [_data(replay) for replay in replays]
    if json:
        console.give_json(
            {
                **runs[0],
                "figures": [str(path) for path in products.figures],
                "video": str(products.video) if products.video else None,
                "report": str(products.report) if products.report else None,
                "exports": [str(path) for path in products.exports],
                "notices": [*dict.fromkeys(n for replay in replays for n in replay.notices), *products.lacks],
                **({"results": runs} if len(runs) > 1 else {}),
                **({"errors": _errors(products)} if products.faults else {}),
            }
        )
        return
    names = list(dict.fromkeys(name for replay in replays for name in replay.outcome.metrics))
    units = {name: unit for replay in replays for name, unit in replay.model.metrics.items()}
    rows = [(n, *(console.shown(r.outcome.metrics.get(n)) for r in replays), units[n]) for n in names]
    if rows:
        values = ["value"] if len(replays) == 1 else [replay.label for replay in replays]
        console.give_table(["measure", *values, "unit"], rows)
    _give_gait(replays)
    if products.figures:
        number = len(products.figures)
        console.give(f"{number} figure{'s' if number > 1 else ''} in {products.folder / 'figures'}")
    for path in (products.video, products.report, *products.exports):
        if path is not None:
            console.give(str(path))


def _give_gait(replays: list[Replay]) -> None:
    """What the legs of each walker do, and how that compares with people."""
    from gaitsim.analysis.gait.numbers import gait_table, norms_table

    for replay in replays:
        title = replay.label if len(replays) > 1 else ""
        for table in (gait_table(replay), norms_table(replay)):
            if table is not None:
                console.give_table(table.columns, table.rows, title)


def _data(replay: Replay) -> dict[str, Any]:
    from gaitsim.analysis.gait.comparison import norm_numbers
    from gaitsim.analysis.gait.numbers import gait_numbers

    outcome = replay.outcome
    return {
        "result": str(replay.path),
        "label": replay.label,
        "status": outcome.status,
        "reason": outcome.reason or None,
        "score": outcome.score,
        "measures": dict(outcome.metrics),
        "units": replay.model.metrics,
        "gait": gait_numbers(replay),
        "norms": norm_numbers(replay),
    }


def _errors(products: Products) -> list[dict[str, Any]]:
    return [fault for error in products.faults for fault in console.error_data(error)["errors"]]
