"""Acceptance of a changed component: everything that uses it is run again with it and compared with what was
recorded.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from gaitsim.cluster.episodes import bundle_episodes
from gaitsim.components.checks.shared import imported_names
from gaitsim.components.find import Library, display_path
from gaitsim.errors import GaitsimError
from gaitsim.results.bundle import COMPONENTS, Bundle
from gaitsim.results.pick import pick
from gaitsim.results.rows import read_rows, row_starts, row_words
from gaitsim.results.store import row_data
from gaitsim.results.trust import check_trust
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.spec.inheritance import override
from gaitsim.spec.resolve import resolve
from gaitsim.study.archive import checked
from gaitsim.study.listening import Listener
from gaitsim.study.records import SCORE, SHORT, STEPS, Difference, Row, Value, differences, read_record, record_path
from gaitsim.study.uses import Scope, UsingResult, using_results, using_specs

RELATIVE = 1e-6  # results have no tolerances; rounding changes a steady gait by less


@dataclass(frozen=True)
class Effect:
    """The effect of the component on one of its users.

    Attributes:
        what: "spec" or "result".
        before: The version with which its record or its copy was made.
        state: "holds", "differs", "same" (the version is the recorded one), "unrecorded", or "error".
    """

    what: str
    name: str
    before: str
    state: str
    differs: tuple[Difference, ...] = ()
    error: GaitsimError | None = None


def tested(reference: str, scope: Scope, trusted: bool, listener: Listener) -> Iterator[Effect]:
    """Run every user of a component with its present version, and compare with its record.

    A user that cannot be run does not stop the others.

    Args:
        reference: The component, such as muscle/geyer2003.
        scope: Where users are searched for.
        trusted: Whether components of results may run that this machine does not know.
        listener: Receives progress.

    Raises:
        Usage: There is no such component.
    """
    version = scope.version(reference)[:SHORT]
    yield from _of_specs(reference, scope, listener)
    texts = _present(scope.library())
    for user in using_results(reference, scope, listener):
        name = display_path(user.folder)
        if user.version == version:
            yield Effect("result", name, user.version, "same")
            continue
        try:
            check_trust(user.bundle, trusted)
            differs = tuple(_of_result(user, _with(user.bundle, reference, texts)))
            yield Effect("result", name, user.version, "differs" if differs else "holds", differs)
        except GaitsimError as error:
            yield Effect("result", name, user.version, "error", error=error)


def _of_specs(reference: str, scope: Scope, listener: Listener) -> Iterator[Effect]:
    """The specs that use it; for those without a record, only their names."""
    users = list(using_specs(reference, scope, listener))
    with_record = [user.archived for user in users if record_path(user.archived.path).is_file()]
    verdicts = {verdict.archived.path: verdict for verdict in checked(with_record, listener)}
    for user in users:
        name, verdict = user.archived.name, verdicts.get(user.archived.path)
        if verdict is None:
            yield Effect("spec", name, "", "unrecorded")
        elif verdict.error is not None:
            yield Effect("spec", name, "", "error", error=verdict.error)
        else:
            before = read_record(user.archived.path).made_from.components.get(reference, "")
            yield Effect("spec", name, before, "differs" if verdict.differs else "holds", verdict.differs)


def _present(library: Library) -> dict[str, str]:
    """The present texts of the libraries, by their places in a bundle."""
    folders = reversed(library.folders)
    files = {f"{COMPONENTS}/{p.parent.name}/{p.name}": p for f in folders for p in sorted(f.glob("*/*")) if _is_code(p)}
    return {place: path.read_text(encoding="utf-8") for place, path in files.items()}


def _is_code(path: Path) -> bool:
    return path.suffix in (".py", ".yaml", ".csv") and path.is_file()


def _with(bundle: Bundle, reference: str, texts: Mapping[str, str]) -> Bundle:
    """A bundle with the present version of a component, and of its shared files, instead of its copies.

    Files that the new version needs and the result lacks come from the libraries.
    """
    place = f"{COMPONENTS}/{reference}"
    others = {path: text for path, text in bundle.files.items() if path.rpartition(".")[0] != place}
    new = {path: text for path, text in texts.items() if path.rpartition(".")[0] == place}
    kind = reference.partition("/")[0]
    shared = {f"{COMPONENTS}/{kind}/{name}.py" for text in new.values() for name in imported_names(text)}
    return replace(bundle, files=dict(texts) | others | new | {path: texts[path] for path in shared if path in texts})


def _of_result(user: UsingResult, bundle: Bundle) -> Iterator[Difference]:
    """The differences that another bundle makes to a result: in every run, or in the best candidate of a search."""
    mode: Mode = "normal" if user.mode == "normal" else "rapid"
    if user.kind == "optimize":
        best = pick(user.folder, "best")
        now = vars(bundle_episodes(bundle, mode).verdict(best.candidate.x))
        units = bundle.model().metrics
        yield from differences([_row(vars(best.verdict), units)], [_row(now, units)])
        return
    document, library, starts = bundle.document(), bundle.library(), bundle.starts()
    for row in read_rows(user.folder):
        variant = document
        for address, text in row["settings"].items():
            variant = override(variant, address, text)
        model = resolve(variant, library, bundle.name).started_at(starts | row_starts(row))
        now = row_data(row["settings"], Simulator(model, mode).run())
        run = row_words(row)
        yield from (replace(d, run=run) for d in differences([_row(row, model.metrics)], [_row(now, model.metrics)]))


def _row(data: Mapping[str, Any], units: Mapping[str, str]) -> Row:
    """A run in the form of a record, with a tolerance for rounding."""
    numbers = {STEPS: (float(data["steps"]), "1"), SCORE: (data["score"], "1")}
    numbers |= {name: (value, units.get(name, "1")) for name, value in data["metrics"].items()}
    values = {n: Value(value=v, unit=unit, tolerance=RELATIVE * abs(v or 0.0)) for n, (v, unit) in numbers.items()}
    return Row(status=data["status"], numbers=values)
