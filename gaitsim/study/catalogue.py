"""A list of the models in an archive, from their own descriptions, sources and records."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from gaitsim.components.bibliography import keys_of
from gaitsim.components.find import display_path
from gaitsim.errors import Faults, GaitsimError
from gaitsim.model import KnownValue
from gaitsim.results.tuned import tuned_path
from gaitsim.spec.inheritance import parents, with_parents
from gaitsim.spec.known import known_values
from gaitsim.spec.schema import header
from gaitsim.study.archive import Archived
from gaitsim.study.known import Compared, compared
from gaitsim.study.listening import Listener
from gaitsim.study.records import BadRecord, Row, read_record
from gaitsim.text.document import MappingNode, dump, plain, read

_SOURCE = re.compile(r"\bsource: ([^,}\n]+)")
_SENTENCE = re.compile(r"(?<!\bal)(?<=[a-z)])[.:](?:\s|$)")


@dataclass(frozen=True)
class Entry:
    """One model: its name, its description and the first sentence of it, and what it is based on.

    Attributes:
        papers: Keys of the bibliography in the sources of its numbers, the most frequent first.
        tuned: The file of its tuned values.
        extends: The spec that it extends.
        metrics: Value and unit of each recorded metric; of a study, those of its first run.
        status: How that run ended; "no record" without one.
        reproduces: Known values and those of that run.
    """

    name: str
    about: str
    summary: str
    papers: tuple[str, ...]
    tuned: str
    extends: str
    status: str
    metrics: dict[str, tuple[float | None, str]]
    reproduces: tuple[Compared, ...] = ()


def entries(specs: Sequence[Archived], listener: Listener) -> Iterator[Entry]:
    """The entries of specs, without running them.

    Args:
        specs: The specs.
        listener: Receives the error of a spec that cannot be read.

    Yields:
        One entry for each readable spec.
    """
    for spec in specs:
        try:
            yield _entry(spec)
        except GaitsimError as error:
            listener.say_error(error)


def _entry(spec: Archived) -> Entry:
    """The entry of a spec.

    Raises:
        InvalidSpec: The spec breaks a rule.
        BadRecord: Its record was edited.
    """
    path = spec.path
    about = " ".join(str(plain(read(path)).get("about", "")).split())
    document = with_parents(path, display_path(path))
    text = dump(plain(document))
    cited = Counter(key for source in _SOURCE.findall(text) for key in keys_of(source))
    above = list(parents(path))
    tuned = next((tuned_path(one).name for one in (path, *above) if tuned_path(one).is_file()), "")
    try:
        run = read_record(path).runs[0]
    except BadRecord:
        run = Row(status="no record", numbers={})
    metrics = {name: (value.value, value.unit) for name, value in run.numbers.items()}
    known = compared(_known(spec, document, {name: value.unit for name, value in run.numbers.items()}), run.numbers)
    papers = tuple(key for key, _ in cited.most_common())
    summary = _SENTENCE.split(about, maxsplit=1)[0]
    return Entry(spec.name, about, summary, papers, tuned, above[0].stem if above else "", run.status, metrics, known)


def _known(spec: Archived, document: MappingNode, recorded: dict[str, str]) -> tuple[KnownValue, ...]:
    """The known values of a spec.

    Args:
        recorded: The units of its metrics.

    Raises:
        InvalidSpec: The spec breaks a rule.
    """
    faults = Faults()
    head, document = header(document, faults)
    faults.raise_if_any()
    assert head is not None
    if any(row.metric not in recorded for row in head.reproduces):
        return spec.models[0].reproduces  # only the model itself knows the units
    found = known_values(document.entries.get("reproduces"), recorded, faults)
    faults.raise_if_any()
    return found
