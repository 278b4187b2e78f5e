"""gaitsim cycle: the periodic gait of a model, and whether it is stable."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries, ModeName, Results, Set, Spec, Trust, opening

if TYPE_CHECKING:
    from gaitsim.study.cycles import Cycle


def cycle(
    spec: Spec,
    mode: Annotated[
        ModeName, typer.Option(help="rapid: native code; normal: plain Python, for debugging.")
    ] = ModeName.rapid,
    settings: Set = None,
    candidate: Annotated[
        str | None, typer.Option(metavar="WHICH", help="Candidate of a result: best, a rank, or GENERATION:INDEX.")
    ] = None,
    results: Results = None,
    start: Annotated[bool, typer.Option("--start", help="Ignore the tuned values beside the spec.")] = False,
    trust: Trust = False,
    library: Libraries = None,
    json: Json = False,
) -> int:
    """Find the periodic gait of a model, and whether it is stable.

    The gait is the fixed point of a return map, and the eigenvalues there say whether it is stable.

    The spec has parameters initial_NAME and, for each, a measure/section of that NAME, whose signal at its next passage
    is what the parameter was at this one. Newton's method starts at the values of the spec.

    Example: gaitsim cycle specs/running_slip.yaml --set leg.touchdown_angle='67 deg'
    """
    from gaitsim.study.cycles import cycle as found

    chosen = opening(spec, settings, library, tuned=not start, trusted=trust, candidate=candidate, results=results)
    talk = console.ConsoleListener(json)
    gait = found(chosen, mode.value, talk, talk.progress("rounds"))
    if json:
        console.give_json(_data(gait))
        return 0
    rows = [(name, f"{gait.in_unit(name):.10g}", gait.units[name]) for name in (*gait.start, *gait.metrics)]
    console.give_table(["of the gait", "value", "unit"], [*rows, ("period", f"{gait.period:.10g}", "s")])
    console.give_table(
        ["eigenvalue", "absolute"], [(f"{_plain(each):.6g}", f"{abs(each):.6g}") for each in gait.eigenvalues]
    )
    stability = "stable: small disturbances die out" if gait.stable else "unstable: small disturbances grow"
    console.say(f"{stability}. It returns to itself within {gait.distance:.1g}, found in {gait.runs} runs.")
    return 0


def _plain(number: complex) -> complex | float:
    return number if number.imag else number.real


def _data(gait: Cycle) -> dict[str, Any]:
    return {
        "start": {name: gait.in_unit(name) for name in gait.start},
        "metrics": {name: gait.in_unit(name) for name in gait.metrics},
        "units": gait.units,
        "period": gait.period,
        "eigenvalues": [[each.real, each.imag] for each in gait.eigenvalues],
        "stable": gait.stable,
        "distance": gait.distance,
        "runs": gait.runs,
    }
