"""The difference of two models: parts, values, connections, and the code of components."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from gaitsim.components.find import KIND
from gaitsim.components.load import digest_of
from gaitsim.model import Model, Part
from gaitsim.results.bundle import COMPONENTS, Bundle
from gaitsim.results.listing import connection_rows, parameter_rows, part_rows

_DIGITS = 12  # digits of a digest, as git shows them
_SEARCH = "search"
Rows = Mapping[str, str]


@dataclass(frozen=True)
class Change:
    """One difference of two models.

    Attributes:
        what: A key of `KINDS`.
        where: Its address, or the file of a component.
        first, second: What each model has; empty for nothing.
    """

    what: str
    where: str
    first: str
    second: str


KINDS = {  # the kind of change: its name in counts
    "part": "parts that only one has",
    "component": "parts with another component",
    "code": "components of the same name with other code",
    "place": "parts fastened elsewhere",
    "connection": "inputs with other senders",
    "curve": "recorded curves",
    "value": "values",
    "tuning": "bounds of tuned values",
    "tuned value": "tuned values",
    "computed": "values computed from others",
    "simulation": "settings of the simulation",
    "search": "settings of the search",
    "version": "versions",
}


def model_changes(first: Model, second: Model) -> list[Change]:
    """The differences of two models. For a part that only one of them has, only that is listed.

    Args:
        first: One model.
        second: The other.

    Returns:
        The differences in the order of `KINDS`.
    """
    uses = [{row["address"]: row["use"] for row in part_rows(model)} for model in (first, second)]
    alone = uses[0].keys() ^ uses[1].keys()
    found = [
        *_changes_in("part", uses[0], uses[1], [a for a in (*uses[0], *uses[1]) if a in alone and not _inside(a, alone)]),
        *_changes_in("component", uses[0], uses[1], [a for a in uses[0] if a not in alone]),
        *_changes_in("place", _places(first), _places(second), unless=alone),
        *_changes_in("connection", _senders(first), _senders(second), unless=alone),
        *_changes_in("curve", _curves(first), _curves(second), unless=alone),
        *_number_changes(first, second, alone),
        *_changes_in("simulation", _simulation(first), _simulation(second)),
    ]
    return ordered(found)


def code_changes(first: Bundle, second: Bundle) -> list[Change]:
    """Find component files of the same name with different texts.

    Args:
        first: The bundle of one model.
        second: That of the other.

    Returns:
        Their digests, and the number of added and removed lines.
    """
    found = []
    for path, text in sorted(first.files.items()):
        other = second.files.get(path, text)
        if not path.startswith(f"{COMPONENTS}/") or path.endswith(f"/{KIND}") or other == text:
            continue
        lines = list(difflib.unified_diff(text.splitlines(), other.splitlines(), lineterm="", n=0))[2:]
        added, removed = (sum(line.startswith(sign) for line in lines) for sign in "+-")
        name = path.removeprefix(f"{COMPONENTS}/")
        second_words = f"{digest_of(other)[:_DIGITS]} (+{added} -{removed} lines)"
        found.append(Change("code", name, digest_of(text)[:_DIGITS], second_words))
    return found


def making_changes(first: Mapping[str, Any], second: Mapping[str, Any]) -> list[Change]:
    """The differences of two manifests: versions, and settings of the searches if both are searches.

    Args:
        first: The manifest of one result; empty for a spec.
        second: That of the other.
    """
    if not (first and second):
        return []
    both = _SEARCH in first and _SEARCH in second
    searches = [{key: str(value) for key, value in each[_SEARCH].items()} if both else {} for each in (first, second)]
    versions = [{"gaitsim": str(each["gaitsim"]), **each.get("versions", {})} for each in (first, second)]
    return [*_changes_in("search", *searches), *_changes_in("version", *versions)]


def ordered(changes: Iterable[Change]) -> list[Change]:
    """Changes in the order of `KINDS`."""
    kinds = list(KINDS)
    return sorted(changes, key=lambda change: kinds.index(change.what))


def counted(changes: Iterable[Change]) -> dict[str, int]:
    """The number of changes of each kind."""
    listed = [change.what for change in changes]
    return {what: listed.count(what) for what in KINDS if what in listed}


def _changes_in(
    what: str, first: Rows, second: Rows, only: Iterable[str] | None = None, unless: Iterable[str] = ()
) -> Iterator[Change]:
    """The differences of two tables, in their order.

    Args:
        only: The rows that count; all by default.
        unless: Parts whose rows do not count.
    """
    without = set(unless)
    for where in dict.fromkeys(only if only is not None else (*first, *second)):
        pair = first.get(where, ""), second.get(where, "")
        if pair[0] != pair[1] and where not in without and not _inside(where, without):
            yield Change(what, where, *pair)


def _inside(address: str, parts: set[str]) -> bool:
    """Whether an address belongs to one of these parts."""
    while "." in address:
        address = address.rpartition(".")[0]
        if address in parts:
            return True
    return False


def _number_changes(first: Model, second: Model, alone: set[str]) -> Iterator[Change]:
    rows = [{row["address"]: row for row in parameter_rows(model)} for model in (first, second)]
    for address in dict.fromkeys((*rows[0], *rows[1])):
        if _inside(address, alone):
            continue
        one, other = (found.get(address) for found in rows)
        if _number(one) != _number(other):
            yield Change(_kind(one, other), address, _number(one), _number(other))
        if one and other and _tuning(one) != _tuning(other):
            yield Change("tuning", address, _tuning(one), _tuning(other))


def _kind(one: Mapping[str, Any] | None, other: Mapping[str, Any] | None) -> str:
    """The kind of change for two numbers that differ."""
    if one is None or other is None:
        return "value"
    if "tune" in one and "tune" in other:
        return "tuned value"
    same = "expression" in one and one.get("expression") == other.get("expression")
    return "computed" if same else "value"


def _number(row: Mapping[str, Any] | None) -> str:
    """A number as text; different numbers have different texts."""
    if row is None:
        return ""
    unit = "" if row["unit"] == "1" else f" {row['unit']}"
    expression = f" ({row['expression']})" if "expression" in row else ""
    return f"{row['value']!r}{unit}{expression}"


def _tuning(row: Mapping[str, Any]) -> str:
    if "tune" not in row:
        return "fixed"
    low, high = row["tune"]
    unit = "" if row["tune_unit"] == "1" else f" {row['tune_unit']}"
    shared = f" as {row['tuned_as']}" if row["tuned_as"] != row["address"] else ""
    return f"{low!r} to {high!r}{unit}{shared}"


def _places(model: Model) -> dict[str, str]:
    """What each part is fastened to: its attachments, and the frames of its points."""
    return {part.address: place for part in model.parts if (place := _place(part))}


def _place(part: Part) -> str:
    points = {name: " ".join(dict.fromkeys(place.frame for place in each)) for name, each in part.points.items()}
    sides = {"mirrored": "yes"} if part.mirrored else {}
    return ", ".join(f"{name}: {value}" for name, value in {**part.attachments, **points, **part.options, **sides}.items())


def _senders(model: Model) -> dict[str, str]:
    """The senders of each input."""
    found: dict[str, list[str]] = {}
    for row in connection_rows(model):
        found.setdefault(row["to"], []).append(row["from"])
    return {target: " + ".join(sorted(sources)) for target, sources in found.items()}


def _curves(model: Model) -> dict[str, str]:
    """Recorded curves: the column, and a digest of the numbers."""
    return {
        f"{part.address}.{name}": f"{curve.column or 'a list'} ({digest_of(repr(curve.values))[:_DIGITS]})"
        for part in model.parts
        for name, curve in part.series.items()
    }


def _simulation(model: Model) -> dict[str, str]:
    """The settings of the simulation, in SI."""
    settings = model.simulate
    return {
        "duration": f"{settings.duration!r} s",
        "step": f"{settings.step!r} s",
        "gravity": f"{settings.gravity!r} m/s^2",
        "integrator": settings.integrator,
    }
