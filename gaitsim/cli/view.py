"""gaitsim view: a run in MuJoCo's viewer."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Libraries, Results, Set, Trust, opening


def view(
    path: Annotated[Path, typer.Argument(metavar="RESULT", help="A result folder, or a spec.")],
    speed: Annotated[float, typer.Option(help="Playback speed; 0.25 is a quarter of real time.")] = 1.0,
    paused: Annotated[bool, typer.Option("--paused", help="Start paused at the first posture.")] = False,
    candidate: Annotated[
        str | None, typer.Option(metavar="WHICH", help="Candidate of a result: best, a rank, or GENERATION:INDEX.")
    ] = None,
    start: Annotated[bool, typer.Option("--start", help="Ignore the tuned values beside the spec.")] = False,
    settings: Set = None,
    results: Results = None,
    trust: Trust = False,
    library: Libraries = None,
) -> None:
    """Show a run in MuJoCo's viewer, repeatedly. Space pauses, left and right step, up and down change the speed.

    Examples:

    gaitsim view results/2026-11-22-hopping-3f9c --speed 0.25

    gaitsim view specs/hopping_leg_mass.yaml --paused
    """
    from gaitsim.errors import Usage

    if not speed > 0:
        raise Usage(f"--speed {speed:g}: seconds of motion in a second, above 0, such as 0.25.")
    from gaitsim.analysis.replays.replay import replayed
    from gaitsim.animation import viewer

    opened = opening(
        path, settings, library, tuned=not start, trusted=trust, candidate=candidate, results=results
    ).open()
    model = opened.model()
    for notice in (*opened.notices, *model.notices):
        console.say(notice)
    viewer.check_display(path)
    replay = replayed(model, path, manifest=opened.manifest)
    if replay.ending:
        console.say(replay.ending)
    viewer.view(replay, speed, paused)
