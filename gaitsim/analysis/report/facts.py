"""The texts and tables of a report: numbers, origin, parts and their sources."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from gaitsim.analysis.drawings.style import labelled, shown_unit
from gaitsim.analysis.drawings.table import Table, formatted
from gaitsim.analysis.replays.replay import Replay
from gaitsim.analysis.searches.convergence import tuned_in
from gaitsim.analysis.searches.draws import DrawResults, draws_of, summaries
from gaitsim.analysis.searches.sweep import study_of
from gaitsim.components.bibliography import read_bibliography
from gaitsim.components.find import library_folders
from gaitsim.errors import InvalidSpec
from gaitsim.model import Model, metric_names
from gaitsim.results.citation import Citation, citations
from gaitsim.results.listing import parameter_rows, part_rows
from gaitsim.results.manifest import BadResult
from gaitsim.results.provenance import provenance


@dataclass(frozen=True)
class Branch:
    """A part of the model with its parameters and its inner parts."""

    address: str
    use: str
    parameters: Table
    inner: list[Branch] = field(default_factory=list)


def metrics_table(replays: Sequence[Replay]) -> Table:
    """Every metric of every run, with its unit and its meaning."""
    docs = {
        name: part.type.metrics[own].doc
        for replay in replays
        for part in replay.model.parts
        for own, name in metric_names(part).items()
    }
    units = {name: unit for replay in replays for name, unit in replay.model.metrics.items()}
    names = dict.fromkeys(name for replay in replays for name in replay.outcome.metrics)
    rows = [
        (
            name,
            *(formatted(replay.outcome.metrics.get(name)) for replay in replays),
            shown_unit(units[name]),
            docs[name],
        )
        for name in names
    ]
    if any(replay.outcome.score is not None for replay in replays):
        scores = (formatted(replay.outcome.score) for replay in replays)
        rows.append(("score", *scores, shown_unit("1"), "The cost that a search lowers."))
    values = ("value",) if len(replays) == 1 else tuple(replay.label for replay in replays)
    return Table(("metric", *values, "unit", "meaning"), tuple(rows), frozenset(range(1, len(replays) + 1)))


def tuned_table(replay: Replay) -> Table | None:
    """The tuned numbers: the values of this run, and those of the search; None if there are none."""
    if not replay.model.free:
        return None
    known = {row.address: row for row in tuned_in(replay.folder, replay.manifest)} if replay.folder else {}
    columns = ("parameter", "value", "unit", "lower", "upper", "start", "best", "mean", "std")
    rows = []
    for free in replay.model.free:
        row = known.get(free.address)
        found = (row.start, row.best, row.mean, row.std) if row else ()
        of = free.unit.of
        numbers = (formatted(n) for n in (of(free.low), of(free.high), *found))
        rows.append((free.address, formatted(of(free.start)), shown_unit(free.unit.text), *numbers))
    width = len(columns) if known else 5
    filled = tuple((*row, *["–"] * width)[:width] for row in rows)
    return Table(columns[:width], filled, frozenset(range(1, width)) - {2})


def study_table(replay: Replay) -> Table | None:
    """The rows of a study: settings, how each ended, and every metric. For draws, a summary of every metric.

    Returns:
        The table; None if it cannot be read.
    """
    try:
        study, draws = study_of(replay), draws_of(replay)
    except BadResult:
        return None
    if draws is not None:
        return _draws_table(draws, replay.model.metrics)
    if study is None:
        return None
    names = [name for name in replay.model.metrics if np.isfinite(study.column(name)).any()]
    units = replay.model.metrics
    columns = (*study.varied, "status", *(labelled(name, units[name]) for name in names))
    rows = tuple(
        (
            *(row.get(address, "–") for address in study.varied),
            status,
            *(formatted(metrics.get(name)) for name in names),
        )
        for row, status, metrics in zip(study.rows, study.statuses, study.metrics, strict=True)
    )
    first = len(study.varied)
    return Table(columns, rows, frozenset(range(len(columns))) - {0, first})


def _draws_table(draws: DrawResults, units: Mapping[str, str]) -> Table:
    """Every metric over all draws: mean, minimum, maximum."""
    rows = tuple(
        (each.name, formatted(each.mean), formatted(each.least), formatted(each.greatest), shown_unit(units[each.name]))
        for each in summaries(draws.metrics)
    )
    return Table(("metric", "mean", "least", "greatest", "unit"), rows, frozenset({1, 2, 3}))


def origin(replay: Replay) -> list[tuple[str, str]]:
    """The origin of a run, as terms and their values."""
    manifest = replay.manifest or provenance(replay.path.parent)
    commit = manifest.get("commit")
    simulate, search = replay.model.simulate, manifest.get("search", {})
    entries = [
        ("Result", str(replay.folder) if replay.folder else f"none kept; {replay.path} was run for this report"),
        ("Made", f"{manifest.get('created', '–')}, {manifest.get('kind', 'analyze')}"),
        ("Mode", str(manifest.get("mode", "rapid"))),
        ("State", str(manifest.get("status", "–")) if replay.manifest else ""),
        ("Command", shlex.join(str(word) for word in manifest.get("command", []))),
        ("Commit", _commit(commit)),
        ("Seed", str(search.get("seed", ""))),
        ("Search", ", ".join(f"{key} {value}" for key, value in search.items() if key != "seed")),
        ("Evaluations", _evaluations(manifest)),
        (
            "Simulation",
            f"{simulate.duration:g} s in steps of {formatted(1000 * simulate.step)} ms, {simulate.integrator}",
        ),
        ("gaitsim", str(manifest.get("gaitsim", "–"))),
        ("Versions", ", ".join(f"{name} {version}" for name, version in manifest.get("versions", {}).items())),
        ("Machine", ", ".join(str(word) for word in manifest.get("machine", {}).values())),
        ("Digest", str(manifest.get("digest", ""))),
    ]
    return [(term, text) for term, text in entries if text]


def _commit(commit: Mapping[str, Any] | None) -> str:
    if not commit:
        return "none: it was not made in a git checkout"
    return f"{commit['hash']}{', with changes that are not committed' if commit['dirty'] else ', clean'}"


def _evaluations(manifest: Mapping[str, Any]) -> str:
    if "evaluations" not in manifest:
        return ""
    stop = f"; stopped: {manifest['stop']}" if manifest.get("stop") else ""
    return f"{manifest['evaluations']}, {manifest.get('failed', 0)} failed{stop}"


def components_table(model: Model) -> Table:
    """Every component file of the model, its digest, and the sources of its numbers."""
    uses: dict[str, list[str]] = {}
    sources: dict[str, dict[str, None]] = {}
    digests = {part.type.reference: part.type.digest for part in model.parts}
    values = {number.address: number.source for number in model.numbers}
    for part in model.parts:
        uses.setdefault(part.type.reference, []).append(part.address)
        own = (values[model.numbers[i].address] for i in part.numbers.values())
        sources.setdefault(part.type.reference, {}).update(dict.fromkeys(s for s in own if s not in ("", "spec")))
    for group in model.groups:
        uses.setdefault(group.reference, []).append(group.address)
    rows = [
        (use, digests.get(use, "")[:12] or "composite", ", ".join(places), "; ".join(sources.get(use, {})) or "–")
        for use, places in sorted(uses.items())
    ]
    return Table(("component", "digest", "used as", "sources of its numbers"), tuple(rows))


@dataclass(frozen=True)
class Reading:
    """One reference: authors, year, title, journal."""

    key: str
    text: str
    doi: str


def references(replay: Replay) -> list[Reading]:
    """The literature of the model; empty if a source is not in the bibliography."""
    folders = library_folders(None if replay.folder else replay.path)
    try:
        found = citations(replay.model, read_bibliography(folders))
    except (InvalidSpec, OSError):
        return []
    return [_reading(entry) for entry in found.entries]


def _reading(entry: Citation) -> Reading:
    authors = [_plain(name.split(",")[0]) for name in re.split(r"\s+and\s+", _field(entry.bibtex, "author"))]
    who = authors[0] if len(authors) == 1 else f"{', '.join(authors[:-1])} & {authors[-1]}"
    places = (_field(entry.bibtex, name) for name in ("journal", "booktitle", "publisher", "version"))
    where = next(filter(None, places), "")
    year = f" ({_field(entry.bibtex, 'year')})" if _field(entry.bibtex, "year") else ""
    text = f"{who}{year}. {_plain(_field(entry.bibtex, 'title'))}. {_plain(where)}".strip(" .") + "."
    return Reading(entry.key, text, _field(entry.bibtex, "doi"))


def _field(bibtex: str, name: str) -> str:
    """A field of a BibTeX entry; empty if it does not exist."""
    match = re.search(rf"^\s*{name}\s*=\s*[{{\"](.*?)[}}\"],?\s*$", bibtex, re.MULTILINE | re.IGNORECASE)
    return match[1] if match else ""


def _plain(text: str) -> str:
    """A BibTeX text without braces and commands."""
    return re.sub(r"\\(?=[&%_$#])|[{}]", "", text).replace("~", " ").replace("--", "–")


def tree(model: Model) -> list[Branch]:
    """The parts of a model as a tree, by their addresses."""
    numbers = parameter_rows(model)
    roots: list[Branch] = []
    known: dict[str, Branch] = {}
    rows = part_rows(model)
    owners = {row["address"] for row in rows}
    for row in rows:
        own = [number for number in numbers if _owner(number["address"], owners) == row["address"]]
        branch = Branch(row["address"], row["use"], _parameters(own, row["address"]))
        above = _owner(row["address"], known)
        (known[above].inner if above else roots).append(branch)
        known[row["address"]] = branch
    return roots


def _owner(address: str, known: Iterable[str]) -> str:
    """The longest known address that contains this one; empty if there is none."""
    pieces = address.split(".")
    above = [".".join(pieces[:i]) for i in range(len(pieces) - 1, 0, -1)]
    return next((each for each in above if each in known), "")


def _parameters(rows: Sequence[Mapping[str, Any]], owner: str) -> Table:
    cells = tuple(
        (
            row["address"].removeprefix(f"{owner}."),
            formatted(row["value"]),
            shown_unit(row["unit"]),
            row.get("expression") or row.get("source") or "–",
        )
        for row in rows
    )
    return Table(("parameter", "value", "unit", "source"), cells, frozenset({1}))


def walk(branches: Sequence[Branch]) -> Iterator[Branch]:
    """All branches, parents first."""
    for branch in branches:
        yield branch
        yield from walk(branch.inner)
