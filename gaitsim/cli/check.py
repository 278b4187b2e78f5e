"""gaitsim check: check a spec without simulating it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, Results, Set, Spec, Trust, opening

if TYPE_CHECKING:
    from gaitsim.errors import Fault


def check(
    spec: Spec,
    settings: Set = None,
    plot: Annotated[bool, typer.Option("--plot", help="Draw the moment arms over the range of every hinge.")] = False,
    folder: Annotated[Path, typer.Option(metavar="FOLDER", help="Folder for the picture of --plot.")] = Path(),
    convergence: Annotated[
        bool, typer.Option("--convergence", help="Compare all metrics at the step, a half and a quarter of it.")
    ] = False,
    tolerance: Annotated[
        float, typer.Option(metavar="SHARE", help="With --convergence: mark larger relative changes.", min=0)
    ] = 0.01,
    results: Results = None,
    trust: Trust = False,
    library: Libraries = None,
    json: Json = False,
) -> None:
    """Check a spec: syntax, units, connections, components, mechanics.

    All faults are reported at once.

    Examples:

    gaitsim check specs/hopping_geyer2003.yaml

    gaitsim check specs/hopping_leg_mass.yaml --plot --folder pictures

    gaitsim check specs/hopping_leg_mass.yaml --convergence
    """
    from gaitsim.analysis.models.moment_arms import draw, table
    from gaitsim.cli.archive import COMPARED_COLUMNS, compared_data, compared_rows
    from gaitsim.cli.convergence import data, give
    from gaitsim.study.soundness import checked

    # With --convergence, what is simulated is what `run` would simulate.
    chosen = opening(spec, settings, library, tuned=convergence, trusted=trust, results=results)
    sound = checked(chosen, convergence, console.ConsoleListener(json))
    model, arms, found = sound.models[0], sound.arms, sound.convergence
    picture = folder / f"{model.name}.moment_arms.png" if plot and arms else None
    if picture is not None:
        draw(arms, picture, model.name)
    counts = {
        "parts": len(model.parts),
        "connections": len(model.connections),
        "tuned": len(model.free),
        "metrics": len(model.metrics),
    }
    if json:
        messages = {"notices": sound.notices, "warnings": [_line(one) for one in sound.warnings]}
        pictures = {"plot": str(picture) if picture else None, "moment_arms": table(arms)} if plot else {}
        changes = {"convergence": [data(one, tolerance) for one in found]} if convergence else {}
        known = {"reproduces": [compared_data(row) for row in sound.known]}
        console.give_json({"status": "valid", **counts, **messages, **known, **pictures, **changes})
        return
    console.give(f"{spec}: valid ({', '.join(f'{n} {name}' for name, n in counts.items())})")
    if sound.known:
        console.give_table(COMPARED_COLUMNS, compared_rows(sound.known))
    for row, converged in zip(sound.rows, found, strict=False):
        if row.settings:
            console.give("\n" + ", ".join(f"{address} = {value}" for address, value in row.settings.items()))
        give(converged, tolerance)
    if plot and arms:
        told_arms = [(row["says"], f"{100 * row['arm']:.3g}") for row in table(arms)]
        console.give_table(["which way each muscle turns each joint", "arm at the start (cm)"], told_arms)
    if plot:
        console.say(f"drawn in {picture}" if picture else "nothing to draw: no path crosses a hinge")


def _line(fault: Fault) -> str:
    """A fault without the line of its file."""
    return ": ".join([*([str(fault.mark)] if fault.mark else []), fault.address, fault.message])
