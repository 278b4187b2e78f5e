"""The references that a paper should cite for a model: sources of its numbers, its components, and tools."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from gaitsim import __version__
from gaitsim.errors import Faults, Mark
from gaitsim.model import Model, Number, Part
from gaitsim.components.bibliography import keys_of, unknown_key
from gaitsim.components.checks.check import declaration_marks, parse

_MUJOCO = "todorov2012"
_OWN = f"""@software{{gaitsim,
  author  = {{{{The gaitsim developers}}}},
  title   = {{gaitsim: neuromuscular gait models from YAML}},
  version = {{{__version__}}}
}}"""
_UNSAID = ("", "spec")


@dataclass(frozen=True)
class Citation:
    """One entry of a bibliography, and what in the model it is cited for."""

    key: str
    bibtex: str
    used_by: tuple[str, ...]


@dataclass(frozen=True)
class Citations:
    """Entries sorted by key, and sources without a key: text -> what has this source."""

    entries: tuple[Citation, ...]
    texts: Mapping[str, tuple[str, ...]]


def citations(model: Model, bibliography: Mapping[str, str], algorithm: tuple[str, ...] = ()) -> Citations:
    """Collect the references of a model.

    Args:
        model: The model.
        bibliography: BibTeX entries by key.
        algorithm: The keys of the algorithm that tuned it.

    Raises:
        InvalidSpec: Sources are not in the bibliography; the error has their places.
    """
    used: dict[str, list[str]] = defaultdict(list)
    texts: dict[str, list[str]] = defaultdict(list)
    faults = Faults()
    for number, part in _numbers(model):
        keys = keys_of(number.source)
        for key in keys:
            if key in bibliography:
                used[key].append(number.address)
            else:
                faults.add(unknown_key(key, set(bibliography)), _place(number, part), number.address)
        if not keys and number.source not in _UNSAID and not number.source.startswith("definition"):
            texts[number.source].append(number.address)
    for known in model.reproduces:
        for key in keys_of(known.source):
            if key in bibliography:
                used[key].append(known.metric)
            else:
                faults.add(unknown_key(key, set(bibliography)), known.mark, known.metric)
    for reference, text in _components(model).items():
        for key in dict.fromkeys(re.findall(r"\w+", f"{reference} {text}")):
            if key in bibliography:
                used[key].append(reference)
    for key in (_MUJOCO, *algorithm):
        if key not in bibliography:
            faults.add(unknown_key(key, set(bibliography)))
    faults.raise_if_any()
    used[_MUJOCO].append("mujoco")
    for key in algorithm:
        used[key].append("optimize")
    entries = [Citation(key, bibliography[key], tuple(dict.fromkeys(used[key]))) for key in sorted(used)]
    own = Citation("gaitsim", _OWN, ("gaitsim",))
    return Citations((own, *entries), {text: tuple(places) for text, places in sorted(texts.items())})


def _numbers(model: Model) -> Iterator[tuple[Number, Part | None]]:
    """Every number that the model depends on, once, with its part if it has one."""
    seen: set[int] = set()
    for index, part in _roots(model):
        todo = [index]
        while todo:
            at = todo.pop()
            if at in seen:
                continue
            seen.add(at)
            number = model.numbers[at]
            yield number, part if at == index else None
            todo += [i for _, i in number.expression.names] if number.expression else []
            todo += [number.fraction_of] if number.fraction_of is not None else []


def _roots(model: Model) -> Iterator[tuple[int, Part | None]]:
    """The numbers of parts, connections and initial values."""
    for part in _parts(model):
        for index in (*part.numbers.values(), *part.constants.values(), *part.coordinates):
            yield index, part
    for connection in model.connections:
        yield from ((index, None) for index in (connection.delay, connection.initial) if index is not None)
    yield from ((index, None) for index in model.initial.values())


def _parts(model: Model) -> Iterable[Part]:
    return (*model.parts, *((term.part for term in model.objective.all) if model.objective else ()))


def _components(model: Model) -> dict[str, str]:
    """The documentation of each component in use; of composites and recorded curves, their names."""
    found = {part.type.reference: part.type.doc for part in _parts(model)}
    recorded = {series.column: series.source for part in _parts(model) for series in part.series.values()}
    return found | recorded | {group.reference: "" for group in model.groups}


def _place(number: Number, part: Part | None) -> Mark | None:
    """The place where the source of a number is written."""
    if number.mark is not None or part is None:
        return number.mark
    component = part.type
    marks = declaration_marks(parse(component.text, component.display_path), component.display_path, component.text.splitlines())
    return marks.get(number.address.rpartition(".")[2])
