"""gaitsim analyze: run a result or a spec once more, and show everything in it."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, Results, Set, Trust, opening
from gaitsim.errors import alternatives
from gaitsim.exchange.formats import FORMATS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from gaitsim.analysis.replays.replay import Replay
    from gaitsim.study.products import Products


Export = StrEnum("Export", {ending: ending for ending in FORMATS})  # type: ignore[misc]  # one declaration of formats
_EXPORTS = alternatives(format.description for format in FORMATS.values())


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
            metavar="SIGNAL",
            help="Draw each maximum of a signal against the previous one; for a measure, of its input.",
        ),
    ] = None,
    candidate: Annotated[
        list[str] | None,
        typer.Option(
            metavar="WHICH", help="best, a rank, or GENERATION:INDEX; the number of a run for a study; repeatable."
        ),
    ] = None,
    export: Annotated[list[Export] | None, typer.Option(help=f"Write all signals as {_EXPORTS}; repeatable.")] = None,
    every: Annotated[
        str | None,
        typer.Option(metavar="TIME", help="Time between exported instants, such as '10 ms' (default: every step)."),
    ] = None,
    from_time: Annotated[
        str | None, typer.Option(metavar="TIME", help="Start of the time interval to show, such as '2 s'.")
    ] = None,
    to_time: Annotated[str | None, typer.Option(metavar="TIME", help="End of the time interval to show.")] = None,
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
    view: Annotated[str, typer.Option(metavar="FROM", help="Camera of the video: side, behind or oblique.")] = "side",
    scopes: Annotated[
        list[str] | None, typer.Option(metavar="PATTERN", help="Signals to show beside the video; repeatable.")
    ] = None,
    formats: Annotated[list[Format] | None, typer.Option("--format", help="Format of the figures; repeatable.")] = None,
    only: Annotated[
        bool,
        typer.Option(
            "--only", help="Make only what other options ask for, without the default figures, video and report."
        ),
    ] = False,
    folder: Annotated[Path | None, typer.Option(metavar="FOLDER", help="Output folder (default: the result).")] = None,
    start: Annotated[bool, typer.Option("--start", help="Ignore the tuned values beside the spec.")] = False,
    results: Results = None,
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
    from gaitsim.study.analyses import AnalysisRequest, analyzed

    wanted = AnalysisRequest(
        plot=tuple(plot or ()),
        against=against,
        return_map=tuple(return_map or ()),
        export=tuple(ending.value for ending in export or ()),
        every=every,
        from_time=from_time,
        to_time=to_time,
        video=video,
        gif=gif,
        speed=speed,
        fps=fps,
        size=size,
        view=view,
        scopes=tuple(scopes or ()),
        formats=tuple(f.value for f in formats or [Format.png]),
        only=only,
        folder=folder,
    )
    chosen = [opening(path, settings, library, not start, trust, results=results) for path in paths]
    found = analyzed(chosen, candidate or (), wanted, console.ConsoleListener(json))
    _tell(found.replays, found.products, json)
    return found.products.exit_code


def _tell(replays: Sequence[Replay], products: Products, json: bool) -> None:
    """Print the measures, and what was made."""
    from gaitsim.analysis.gait.changes import gait_changes

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
                **({"results": runs, "changes": gait_changes(replays)} if len(runs) > 1 else {}),
                **({"errors": _errors(products)} if products.faults else {}),
            }
        )
        return
    names = list(dict.fromkeys(name for replay in replays for name in replay.outcome.metrics))
    units = {name: unit for replay in replays for name, unit in replay.model.metrics.items()}
    rows = [(n, *(console.formatted(r.outcome.metrics.get(n)) for r in replays), units[n]) for n in names]
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


def _give_gait(replays: Sequence[Replay]) -> None:
    """Print the gait of each walker, compared with people."""
    from gaitsim.analysis.gait.changes import changes_table
    from gaitsim.analysis.gait.numbers import gait_table, norms_table

    for replay in replays:
        title = replay.label if len(replays) > 1 else ""
        for table in (gait_table(replay), norms_table(replay)):
            if table is not None:
                console.give_table(table.columns, table.rows, title)
    changes = changes_table(replays)
    if changes is not None:
        console.give_table(changes.columns, changes.rows, f"changes from {changes.columns[2]}")


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
