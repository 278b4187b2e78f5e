"""What a model is made of, with its starts: a document, its components, and where they come from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from collections.abc import Mapping as Map
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from gaitsim.cluster.episodes import first_episode
from gaitsim.model import Model
from gaitsim.parts.find import Library
from gaitsim.results.bundle import Bundle, bundled
from gaitsim.results.manifest import read_result
from gaitsim.results.pick import pick
from gaitsim.results.rows import pick_row, read_rows, row_starts, row_words
from gaitsim.results.trust import check_trust
from gaitsim.spec.document import Mapping
from gaitsim.spec.inheritance import override, split_setting, without
from gaitsim.spec.resolve import resolve


@dataclass(frozen=True)
class Source:
    """A document, the components it may use, and where its tuned numbers start.

    origin: where the starts come from, in words.
    manifest, recorded: of a result, and what it says of the run that this is (as `row_data`).
    """

    document: Mapping
    library: Library
    name: str
    starts: Map[str, float]
    notices: tuple[str, ...] = ()
    manifest: Map[str, Any] = field(default_factory=dict)
    recorded: Map[str, Any] = field(default_factory=dict)
    origin: str = ""

    def model(self, document: Mapping | None = None) -> Model:
        """The model of the document, or of a variant of it."""
        return resolve(document or self.document, self.library, self.name).started_at(self.starts, self.origin)

    def bundle(self, models: Iterable[Model]) -> Bundle:
        """The source as files, given the models made of it."""
        return bundled(self.document, self.name, self.library, self.starts, models)


def source_of_result(folder: Path, settings: Sequence[str], trusted: bool, candidate: str | None) -> Source:
    """A result's own spec and components, started at one of its candidates.

    candidate: of a search (best if None), or a run of a study; None leaves a study what it is.
    Errors: BadResult, Untrusted, InvalidSpec, Usage.
    """
    manifest, bundle = read_result(folder)
    check_trust(bundle, trusted)
    document, library, name = bundle.document(), bundle.library(), bundle.name
    starts, recorded, notice = bundle.starts(), {}, ""
    if manifest["kind"] == "optimize":
        evaluation = pick(folder, candidate or "best")
        place, recorded = evaluation.candidate, dict(vars(evaluation.verdict))
        starts = dict(zip((f.address for f in bundle.model().free), place.x, strict=True))
        notice = f"candidate {place.generation}:{place.index} of {folder}"
        document, recorded, told = first_episode(document, recorded)
        notice += told
        if evaluation.verdict.status in ("killed", "timeout"):
            notice += f", which the search had to end ({evaluation.verdict.reason}); Ctrl-C ends it here"
            recorded = {}
    elif candidate is not None:
        rows, chosen = read_rows(folder), pick_row(folder, candidate)
        recorded, document = rows[chosen], without(document, "study")
        starts |= row_starts(recorded)
        for address, text in recorded["settings"].items():
            document = override(document, address, text)
        notice = f"run {chosen + 1} of {len(rows)} of {folder}: {row_words(recorded)}" if len(rows) > 1 else ""
    for setting in settings:
        document, recorded = override(document, *split_setting(setting)), {}
    return Source(document, library, name, starts, (notice,) if notice else (), manifest, recorded, str(folder))
