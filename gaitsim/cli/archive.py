"""gaitsim archive: models with records of their runs, and whether they still agree."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gaitsim.cli import console
from gaitsim.cli.options import Json, Libraries
from gaitsim.errors import ExitCode, command

if TYPE_CHECKING:
    from gaitsim.study.archive import Verdict
    from gaitsim.study.known import Compared
    from gaitsim.study.records import Difference

_HEADLINES = 4
app = typer.Typer(help="List, check and record models that run.", rich_markup_mode=None)


def _names(incomplete: str) -> list[str]:
    from gaitsim.distribution import shipped_specs

    return [name for name in shipped_specs() if name.startswith(incomplete)]


What = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="[NAME | SPEC | FOLDER]...",
        help="Names of shipped specs, specs, or folders of specs (default: all shipped specs).",
        autocompletion=_names,
    ),
]


@app.command("list")
def list_models(what: What = None, json: Json = False) -> None:
    """List models with their papers, known values and records.

    Example: gaitsim archive list
    """
    from gaitsim.study.archive import archived
    from gaitsim.study.catalogue import entries
    from gaitsim.study.known import summary

    found = list(entries(archived(what or []), console.ConsoleListener(json)))
    if json:
        known = [[compared_data(row) for row in entry.reproduces] for entry in found]
        models = [{**vars(entry), "reproduces": rows} for entry, rows in zip(found, known, strict=True)]
        console.give_json({"models": models})
        return
    rows = [(e.name, e.summary, ", ".join(e.papers), summary(e.reproduces), _headline(e.metrics)) for e in found]
    console.give_table(["model", "what it is", "papers", "how well it has known values", "as recorded"], rows)
    compared = [(entry.name, *cells) for entry in found for cells in compared_rows(entry.reproduces)]
    if compared:
        console.give("")
        console.give_table(["model", *COMPARED_COLUMNS], compared)


@app.command("check")
def check(what: What = None, library: Libraries = None, json: Json = False) -> int:
    """Run models again, in parallel, and compare with their records.

    Examples:

    gaitsim archive check

    gaitsim archive check hopping_geyer2003 walking_geyer2010
    """
    from gaitsim.study.archive import archived, checked

    verdicts = list(checked(archived(what or [], library or ()), console.ConsoleListener(json)))
    wrong = [verdict for verdict in verdicts if not verdict.holds]
    if json:
        console.give_json({"status": "differs" if wrong else "holds", "models": [_data(v) for v in verdicts]})
    else:
        rows = [row for verdict in wrong for row in difference_rows(verdict.archived.name, verdict.differs)]
        if rows:
            console.give_table(DIFFERENCE_COLUMNS, rows)
        console.give(f"{len(verdicts) - len(wrong)} of {len(verdicts)} models do what was recorded")
        for verdict in wrong:
            if verdict.error:
                console.say_error(verdict.error)
            if verdict.changed:
                console.say(f"{verdict.archived.name}: changed since it was recorded: {', '.join(verdict.changed)}")
        differing = [verdict.archived.name for verdict in wrong if verdict.differs]
        if differing:
            console.say(f"if this is meant: {command('archive', 'record', *differing)}")
    return ExitCode.FAILED if wrong else 0


@app.command("record")
def record(what: What = None, library: Libraries = None, json: Json = False) -> int:
    """Run models and write their records, in records/ beside each spec. Recorded numbers that still hold are kept.

    Each model runs three times, to estimate how much rounding on another machine may change its metrics.

    Examples:

    gaitsim archive record hopping_geyer2003

    gaitsim archive record specs
    """
    from gaitsim.components.find import display_path
    from gaitsim.study.archive import archived, recorded

    wrong, data = False, []
    for made in recorded(archived(what or [], library or ()), console.ConsoleListener(json)):
        wrong = wrong or made.error is not None
        data.append(
            {
                "model": made.archived.name,
                "record": str(made.path),
                "what": made.what,
                "differs": [difference_data(d) for d in made.differs],
                **(console.error_data(made.error) if made.error else {}),
            }
        )
        if json:
            continue
        if made.error:
            console.say_error(made.error)
            continue
        console.give(f"{display_path(made.path)}: {made.what}")
        if made.differs:
            console.give_table(DIFFERENCE_COLUMNS, difference_rows(made.archived.name, made.differs))
    if json:
        console.give_json({"records": data})
    return ExitCode.FAILED if wrong else 0


DIFFERENCE_COLUMNS = ("model", "run", "metric", "recorded", "now", "unit", "change", "tolerance")


def difference_rows(name: str, differs: Sequence[Difference]) -> list[tuple[str, ...]]:
    """Differences as rows of a table."""
    return [
        (
            name,
            d.run,
            d.metric,
            _value_text(d.recorded),
            _value_text(d.now),
            d.unit if d.unit != "1" else "",
            "" if d.change is None else f"{100 * d.change:+.2g} %",
            "" if d.tolerance is None else f"{d.tolerance:.2g}",
        )
        for d in differs
    ]


COMPARED_COLUMNS = ("what it should have", "metric", "known value", "model", "difference", "within", "source")


def compared_rows(rows: Iterable[Compared]) -> list[tuple[str, ...]]:
    """Known values beside those of a model, as rows of a table."""
    from gaitsim.units import with_unit

    answers = {True: "yes", False: "no", None: ""}
    return [
        (
            row.what,
            row.metric,
            with_unit(f"{row.known:.9g}", row.unit),
            "-" if row.model is None else with_unit(f"{row.model:.9g}", row.unit),
            _difference(row),
            answers[row.holds],
            row.source,
        )
        for row in rows
    ]


def compared_data(row: Compared) -> dict[str, Any]:
    """A known value beside that of a model, as data."""
    return {**vars(row), "difference": row.difference, "share": row.share, "holds": row.holds}


def _difference(row: Compared) -> str:
    if row.difference is None:
        return ""
    share = "" if row.share is None else f" ({100 * row.share:+.2g} %)"
    return f"{row.difference:+.2g}{share}"


def _headline(metrics: Mapping[str, tuple[float | None, str]]) -> str:
    """A few metrics in words; --json has all."""
    from gaitsim.model import headline_metrics
    from gaitsim.units import with_unit

    names = headline_metrics(metrics)
    few = [f"{n} {with_unit(console.formatted(metrics[n][0]), metrics[n][1])}" for n in names[:_HEADLINES]]
    return ", ".join(few) or "no record"


def _value_text(value: float | str | None) -> str:
    return f"{value:.9g}" if isinstance(value, float) else value or "-"


def difference_data(one: Difference) -> dict[str, Any]:
    """A difference as data."""
    return {**vars(one), "change": one.change}


def _data(verdict: Verdict) -> dict[str, Any]:
    return {
        "model": verdict.archived.name,
        "spec": str(verdict.archived.path),
        "holds": verdict.holds,
        "differs": [difference_data(d) for d in verdict.differs],
        "changed": list(verdict.changed),
        **({"errors": console.error_data(verdict.error)["errors"]} if verdict.error else {}),
    }
