"""gaitsim check: is a spec sound? Nothing is simulated."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, Set, Spec, Trust
from gaitsim.cli.source import open_source

if TYPE_CHECKING:
    from gaitsim.errors import Fault


def check(
    spec: Spec,
    settings: Set = None,
    plot: Annotated[bool, typer.Option("--plot", help="Draw moment arms over the range of every hinge.")] = False,
    folder: Annotated[Path, typer.Option(metavar="FOLDER", help="Where the picture of --plot goes.")] = Path(),
    trust: Trust = False,
    library: Libraries = None,
    json: Json = False,
) -> None:
    """Check a spec: grammar, units, wiring, components, mechanics. All faults at once.

    Examples:

    gaitsim check specs/hopping_geyer2003.yaml

    gaitsim check specs/hopping_leg_mass.yaml --plot --folder pictures
    """
    from gaitsim.analysis.moment_arms import draw, warnings
    from gaitsim.simulation.moment_arms import moment_arms
    from gaitsim.simulation.run import Simulator
    from gaitsim.spec.study import variants

    source = open_source(spec, settings, library, tuned=False, trusted=trust)
    models = [source.model(row.document) for row in variants(source.document, [])]
    for each in models:
        Simulator(each)
    model = models[0]
    for notice in (*source.notices, *model.notices):
        console.say(notice)
    arms = moment_arms(model)
    doubts = warnings(arms)
    for doubt in doubts:
        console.say(f"warning: {doubt}")
    picture = folder / f"{source.name}.moment_arms.png" if plot and arms else None
    if picture is not None:
        draw(arms, picture, source.name)
    counts = {
        "parts": len(model.parts),
        "connections": len(model.connections),
        "tuned": len(model.free),
        "metrics": len(model.metrics),
    }
    if json:
        told = {"notices": [*source.notices, *model.notices], "warnings": [_line(doubt) for doubt in doubts]}
        drawn = {"plot": str(picture) if picture else None} if plot else {}
        console.give_json({"status": "valid", **counts, **told, **drawn})
        return
    console.give(f"{spec}: valid ({', '.join(f'{n} {name}' for name, n in counts.items())})")
    if plot:
        console.say(f"drawn in {picture}" if picture else "nothing to draw: no path of points crosses a hinge")


def _line(fault: Fault) -> str:
    """A fault without its line of the file."""
    return ": ".join([*([str(fault.mark)] if fault.mark else []), fault.address, fault.message])
