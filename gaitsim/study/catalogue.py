"""What the models of an archive are, by their own words, their sources, and their records."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from gaitsim.components.bibliography import keys_of
from gaitsim.components.find import shown
from gaitsim.errors import GaitsimError
from gaitsim.results.tuned import tuned_path
from gaitsim.spec.inheritance import parents, with_parents
from gaitsim.study.archive import Archived
from gaitsim.study.listening import Listener
from gaitsim.study.records import BadRecord, read_record
from gaitsim.text.document import dump, plain, read

_SOURCE = re.compile(r"\bsource: ([^,}\n]+)")
_SENTENCE = re.compile(r"(?<!\bal)(?<=[a-z)])[.:](?:\s|$)")


@dataclass(frozen=True)
class Entry:
    """One model: its name, what it says of itself and the first sentence of that, and what stands behind it.

    papers: keys of the bibliography that sources of its numbers name, the most frequent first. tuned: the file of its
    tuned values. extends: the spec that it varies. metrics: value and unit of each as recorded; of a study of its first
    run. status: how that ended; "no record" without one.
    """

    name: str
    about: str
    summary: str
    papers: tuple[str, ...]
    tuned: str
    extends: str
    status: str
    metrics: dict[str, tuple[float | None, str]]


def entries(specs: Sequence[Archived], listener: Listener) -> Iterator[Entry]:
    """What there is to say of specs; nothing is run. Of one that cannot be read the listener hears."""
    for spec in specs:
        try:
            yield _entry(spec)
        except GaitsimError as error:
            listener.say_error(error)


def _entry(spec: Archived) -> Entry:
    """Errors: InvalidSpec, BadRecord for one that was edited."""
    path = spec.path
    about = " ".join(str(plain(read(path)).get("about", "")).split())
    text = dump(plain(with_parents(path, shown(path))))
    cited = Counter(key for source in _SOURCE.findall(text) for key in keys_of(source))
    above = list(parents(path))
    tuned = next((tuned_path(one).name for one in (path, *above) if tuned_path(one).is_file()), "")
    status, metrics = "no record", dict[str, tuple[float | None, str]]()
    try:
        run = read_record(path).runs[0]
        status, metrics = run.status, {name: (value.value, value.unit) for name, value in run.numbers.items()}
    except BadRecord:
        pass
    papers = tuple(key for key, _ in cited.most_common())
    summary = _SENTENCE.split(about, maxsplit=1)[0]
    return Entry(spec.name, about, summary, papers, tuned, above[0].stem if above else "", status, metrics)
