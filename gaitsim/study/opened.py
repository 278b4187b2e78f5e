"""Opened specs and results: a document, its components, and the start of its tuned numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from gaitsim.components.find import Library
from gaitsim.model import Model
from gaitsim.results.bundle import Bundle, bundled
from gaitsim.results.manifest import read_result
from gaitsim.results.rows import pick_row, read_rows, row_starts, row_words
from gaitsim.results.trust import check_trust
from gaitsim.spec.inheritance import override, split_setting, without
from gaitsim.spec.resolve import resolve
from gaitsim.spec.schema import optimize_section
from gaitsim.spec.study import episodes
from gaitsim.text.document import MappingNode


@dataclass(frozen=True)
class Opened:
    """A spec or a result that was opened.

    Attributes:
        document: The spec.
        library: The components that it may use.
        name: The name of the model.
        starts: The starts of tuned numbers, in SI by address.
        notices: Notices for the user.
        manifest: The manifest of a result; empty for a spec.
        recorded: What a result recorded of this run, as `row_data`; empty for a spec.
        origin: The file or the result that the starts come from.
        place: The folder of the spec; the current folder for a result.
        more: Further files of the bundle.
    """

    document: MappingNode
    library: Library
    name: str
    starts: Mapping[str, float]
    notices: tuple[str, ...] = ()
    manifest: Mapping[str, Any] = field(default_factory=dict)
    recorded: Mapping[str, Any] = field(default_factory=dict)
    origin: str = ""
    place: Path = Path()
    more: Mapping[str, str] = field(default_factory=dict)
    _resolved: dict[int, tuple[MappingNode, Model]] = field(
        default_factory=dict, repr=False
    )  # by the id of the document

    def model(self, document: MappingNode | None = None) -> Model:
        """The model of the document, which is resolved once, or of a variant of the document."""
        return self._written(document or self.document).started_at(self.starts, self.origin)

    def _written(self, document: MappingNode) -> Model:
        """The model with the starts of the document."""
        if document is not self.document:
            return resolve(document, self.library, self.name)
        if id(document) not in self._resolved:
            self._resolved[id(document)] = document, resolve(document, self.library, self.name)
        return self._resolved[id(document)][1]

    def bundle(self, models: Iterable[Model]) -> Bundle:
        """The bundle of the document and its models."""
        made = bundled(self.document, self.name, self.library, self.starts, models)
        return replace(made, files=made.files | dict(self.more))


def open_result(folder: Path, settings: Sequence[str], trusted: bool, candidate: str | None) -> Opened:
    """Open a result at one of its candidates, with its own spec and components.

    Args:
        folder: The result.
        settings: Overrides, each as ADDRESS=VALUE.
        trusted: Whether the user trusts its components.
        candidate: A candidate of a search (the best if None), or a run of a study; None keeps the whole study.

    Raises:
        BadResult: The folder is not a result, or the result is damaged.
        Untrusted: The result has components that this machine does not trust.
        InvalidSpec: The spec breaks a rule.
        Usage: The request does not fit.
    """
    from gaitsim.results.pick import pick

    manifest, bundle = read_result(folder)
    check_trust(bundle, trusted)
    document, library, name = bundle.document(), bundle.library(), bundle.name
    starts, recorded, notice = bundle.starts(), {}, ""
    if manifest["kind"] == "optimize":
        evaluation = pick(folder, candidate or "best")
        place, recorded = evaluation.candidate, dict(vars(evaluation.verdict))
        starts = dict(zip((f.address for f in bundle.model().free), place.x, strict=True))
        notice = f"candidate {place.generation}:{place.index} of {folder}"
        document, recorded, episode = _first_episode(document, recorded)
        notice += episode
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
    return Opened(document, library, name, starts, (notice,) if notice else (), manifest, recorded, str(folder))


def _first_episode(document: MappingNode, verdict: Mapping[str, Any]) -> tuple[MappingNode, dict[str, Any], str]:
    """The spec of a search's first episode, what was recorded of it, and a notice about the other episodes."""
    rows, found = episodes(document), verdict["episodes"]
    if not rows[0].settings:
        return document, dict(verdict), ""
    episode = f", episode 1 of {len(rows)}: {', '.join(f'{a} = {v}' for a, v in rows[0].settings.items())}"
    if not found:
        return rows[0].document, dict(verdict), episode
    scores = ", ".join("failed" if one["score"] is None else f"{one['score']:.5g}" for one in found)
    how = optimize_section(document).combine
    episode += (
        f" (the episodes' scores are {scores}; the candidate's is their {how}); for another one, --set its values"
    )
    return rows[0].document, dict(verdict) | found[0], episode
