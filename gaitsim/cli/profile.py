"""gaitsim profile: what each part of a model costs in run time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, Results, Set, Spec, Trust, opening
from gaitsim.study.opening import only_row

if TYPE_CHECKING:
    from collections.abc import Sequence

    from gaitsim.simulation.profile import Cost, Profile

_ROWS = 20


def profile(
    spec: Spec,
    settings: Set = None,
    components: Annotated[
        bool, typer.Option("--components", help="One row for each component instead of each part.")
    ] = False,
    plot: Annotated[bool, typer.Option("--plot", help="Draw the largest costs.")] = False,
    folder: Annotated[Path, typer.Option(metavar="FOLDER", help="Folder for the picture of --plot.")] = Path(),
    candidate: Annotated[
        str | None, typer.Option(metavar="WHICH", help="Candidate of a result: best, a rank, or GENERATION:INDEX.")
    ] = None,
    start: Annotated[bool, typer.Option("--start", help="Ignore the tuned values beside the spec.")] = False,
    results: Results = None,
    trust: Trust = False,
    library: Libraries = None,
    json: Json = False,
) -> None:
    """Measure the run time of each part and of each stage of MuJoCo.

    The model runs several times, with and without a stopwatch in its native code.

    Examples:

    gaitsim profile specs/walking_geyer2010.yaml

    gaitsim profile specs/walking_geyer2010.yaml --components --plot --folder pictures
    """
    from gaitsim.simulation.profile import profile as measured

    opened = opening(
        spec, settings, library, tuned=not start, trusted=trust, candidate=candidate, results=results
    ).open()
    model = opened.model(only_row(opened, spec).document)
    for notice in dict.fromkeys([*opened.notices, *model.notices]):
        console.say(notice)
    found = measured(model)
    costs = found.by_component() if components else found.costs
    picture = None
    if plot:
        from gaitsim.analysis.drawings.drawing import save
        from gaitsim.analysis.models.costs import cost_figure

        (picture,) = save([cost_figure(costs, found, opened.name)], folder)
    if json:
        console.give_json(_data(costs, found) | ({"plot": str(picture)} if plot else {}))
        return
    _give(costs, found)
    if picture is not None:
        console.say(f"drawn in {picture}")


def _give(costs: Sequence[Cost], found: Profile) -> None:
    rows = [(cost.name, cost.use, str(cost.calls), *_numbers(cost.seconds, found)) for cost in costs[:_ROWS]]
    if rest := costs[_ROWS:]:
        seconds = sum(cost.seconds for cost in rest)
        rows.append((f"{len(rest)} others", "", str(sum(cost.calls for cost in rest)), *_numbers(seconds, found)))
    console.give_table(["part", "component", "calls a step", "ns a step", "share"], rows)
    console.give(f"a step takes {1e9 * found.step:,.0f} ns, and {found.slower:.2f} times as long with the stopwatch")


def _numbers(seconds: float, found: Profile) -> tuple[str, str]:
    return f"{1e9 * seconds:,.0f}", f"{100 * seconds / found.measured:.1f} %"


def _data(costs: Sequence[Cost], found: Profile) -> dict[str, Any]:
    rows = [
        {"part": cost.name, "component": cost.use, "calls": cost.calls, "seconds": cost.seconds}
        | {"share": cost.seconds / found.measured}
        for cost in costs
    ]
    return {"step_seconds": found.step, "times_slower": found.slower, "steps": found.steps, "costs": rows}
