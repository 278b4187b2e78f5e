"""gaitsim limit: how far numbers of a spec can go before a run ends, by bisection."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import RESULTS, Json, Libraries, ModeName, Set, Spec, Trust

if TYPE_CHECKING:
    from gaitsim.analysis.limits import Hunt, Limit

_FINEST = 1e-6


def limit(
    spec: Spec,
    vary: Annotated[
        list[str],
        typer.Option(metavar="ADDRESS=FROM:TO", help="What goes how far, from a value at which all is well; repeatable."),
    ],
    until: Annotated[
        str | None,
        typer.Option(metavar="METRIC=VALUE", help="What ends it; unless given, a run that does not complete."),
    ] = None,
    tolerance: Annotated[float, typer.Option(metavar="SHARE", help="How exactly, in parts of the range.")] = 0.01,
    points: Annotated[int, typer.Option(metavar="COUNT", help="Values of the first scan, both ends included.")] = 9,
    mode: Annotated[ModeName, typer.Option(help="Native code, or plain Python for debugging.")] = ModeName.rapid,
    settings: Set = None,
    no_save: Annotated[bool, typer.Option("--no-save", help="Keep no result folder.")] = False,
    origin: Annotated[
        str | None, typer.Option("--from", metavar="RESULT", help="Start at the best values of a result.")
    ] = None,
    candidate: Annotated[
        str | None, typer.Option(metavar="WHICH", help="Of a result: best, a rank, or GENERATION:INDEX.")
    ] = None,
    start: Annotated[bool, typer.Option("--start", help="Ignore tuned values beside the spec.")] = False,
    trust: Trust = False,
    library: Libraries = None,
    json: Json = False,
) -> int:
    """Find how far numbers can go before a run ends: pushes, slopes, steps, noise.

    Each --vary is looked through alone: a scan over its range, then bisection where runs end first.

    Example: gaitsim limit specs/walking_geyer2010_perturbed.yaml --vary push.strength='0 N:400 N'
    """
    from gaitsim.analysis.limits import Hunt, Limit, until_of
    from gaitsim.cli.products import started_from
    from gaitsim.cli.source import open_source
    from gaitsim.errors import Usage
    from gaitsim.optimization.limit import Bracket
    from gaitsim.spec.study import span, variants

    _check_numbers(points, tolerance)
    limits = [Limit(*span(text), Bracket(points, tolerance)) for text in vary]
    source = open_source(spec, settings, library, tuned=not start, trusted=trust, candidate=candidate)
    rows = variants(source.document, [])
    if len(rows) > 1:
        raise Usage(f"{spec} is a study of {len(rows)} runs; take one with --candidate, or drop it: --set study=null.")
    model = source.model(rows[0].document)
    for notice in dict.fromkeys([*source.notices, *model.notices]):
        console.say(notice)
    hunt = Hunt(source, rows[0].document, rows[0].settings, limits, until_of(until, model), mode.value)
    hear = console.progress("runs")
    hunt.run(lambda done: hear(done, done + 1))
    hear(1, 1)
    folder = None if no_save else _saved(hunt)
    _report(hunt, folder, json)
    return 0
