"""The archive: models with a record of their runs, and the check that they still give the same results."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from gaitsim.components.find import Library, display_path
from gaitsim.components.load import digest_of
from gaitsim.distribution import shipped_specs
from gaitsim.errors import Fault, GaitsimError, Mark, SimulationFailed, Usage, did_you_mean
from gaitsim.model import Model
from gaitsim.results.store import CannotSave
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Simulator
from gaitsim.simulation.threads import cores, in_threads
from gaitsim.spec.inheritance import without
from gaitsim.spec.study import Variant, variants
from gaitsim.study.listening import Listener
from gaitsim.study.opened import Opened
from gaitsim.study.opening import Opening
from gaitsim.study.records import (
    OR,
    SCORE,
    SHORT,
    STEPS,
    BadRecord,
    Difference,
    MadeFrom,
    Recorded,
    Row,
    Value,
    differences,
    finite,
    read_record,
    record_path,
    run_words,
    updated,
    write_record,
)
from gaitsim.text.document import dump, plain

# Other machines round differently, by 1e-16 of a number in each operation. A billionth of gravity is far more than
# that, so its effect shows how far numbers may differ. Differences below the first number are ignored.
_NUDGE = 1e-9
_RELATIVE, _RESPONSES, _ABSOLUTE = 1e-6, 2.0, 1e-12


@dataclass(frozen=True)
class Archived:
    """A spec of an archive, and its name."""

    name: str
    path: Path
    folders: tuple[Path, ...] = ()

    @cached_property
    def opened(self) -> Opened:
        """The spec at its tuned values. Raises the errors of `Opening.open`."""
        return Opening(self.path, folders=self.folders).open()

    @cached_property
    def rows(self) -> list[Variant]:
        """Its runs: one, or those of its study.

        Raises:
            InvalidSpec: The spec breaks a rule.
        """
        return variants(self.opened.document, [])

    @cached_property
    def models(self) -> list[Model]:
        """The model of each run.

        Raises:
            InvalidSpec: The spec breaks a rule.
            InvalidComponent: A component file breaks the contract.
        """
        return [self.opened.model(row.document) for row in self.rows]

    def made_from(self) -> MadeFrom:
        """The versions of everything that the models are made from."""
        assert self.models
        opened = self.opened
        tuned = digest_of(json.dumps(dict(opened.starts)))[:SHORT] if opened.starts else None
        return MadeFrom(
            spec=digest_of(dump(plain(without(opened.document, "reproduces"))))[:SHORT],
            tuned=tuned,
            components=versions(opened.library),
        )


@dataclass(frozen=True)
class Verdict:
    """The result of checking a model: the differences from its record, and what has changed since; or the reason why
    it could not be checked.
    """

    archived: Archived
    differs: tuple[Difference, ...] = ()
    changed: tuple[str, ...] = ()
    error: GaitsimError | None = None

    @property
    def holds(self) -> bool:
        """Whether the model still gives the recorded results."""
        return self.error is None and not self.differs


@dataclass(frozen=True)
class Recording:
    """The outcome of recording a model: new, unchanged, changed (with the differences), or an error."""

    archived: Archived
    path: Path
    what: str
    differs: tuple[Difference, ...] = ()
    error: GaitsimError | None = None


def versions(library: Library) -> dict[str, str]:
    """The first letters of the digest of each used component and table, by reference."""
    files = {r: c.digest for r, c in library.used().items()}
    tables = {r: digest_of(table.text) for r, table in library.used_tables().items()}
    return {reference: digest[:SHORT] for reference, digest in sorted((files | tables).items())}


def archived(names: Sequence[str], folders: Sequence[Path] = ()) -> list[Archived]:
    """Find specs.

    Args:
        names: Names of shipped specs, paths of specs, and folders of specs; all shipped specs if there are none.
        folders: Folders of more components.

    Raises:
        Usage: There is no such spec.
    """
    known, extra = shipped_specs(), tuple(folders)
    found: dict[Path, Archived] = {}
    for word in names or known:
        path = Path(word)
        if word in known:
            one = [Archived(word, known[word], extra)]
        elif path.is_dir():
            one = [Archived(str(path / file.name), path / file.name, extra) for file in _specs_in(path)]
        elif path.suffix == ".yaml":
            one = [Archived(word, path, extra)]
        else:
            hint = did_you_mean(word, known)
            raise Usage(f"{word}: this is neither a shipped spec, nor a .yaml file, nor a folder. {hint}")
        if not one:
            raise Usage(f"{word}: there is no spec in this folder; name one that has some.")
        found |= {each.path.resolve(): each for each in one}
    return list(found.values())


def recorded(specs: Sequence[Archived], listener: Listener) -> Iterator[Recording]:
    """Run specs three times each and write their records.

    Args:
        specs: The specs.
        listener: Receives progress.

    Yields:
        What became of each record. A spec that fails does not stop the others.
    """
    for spec, found in _run(specs, (0.0, _NUDGE, -_NUDGE), listener):
        path = record_path(spec.path)
        try:
            yield _written(spec, path, found)
        except GaitsimError as error:
            yield Recording(spec, path, "failed", error=error)


def checked(specs: Sequence[Archived], listener: Listener) -> Iterator[Verdict]:
    """Run specs again and compare with their records.

    Args:
        specs: The specs.
        listener: Receives progress.

    Yields:
        The verdict of each spec. One that fails does not stop the others.
    """
    known: dict[Path, Recorded] = {}
    wrong: dict[Path, GaitsimError] = {}
    for spec in specs:
        try:
            known[spec.path] = read_record(spec.path)
        except GaitsimError as error:
            wrong[spec.path] = error
    ran = dict(_run([spec for spec in specs if spec.path in known], (0.0,), listener))
    for spec in specs:
        found = ran.get(spec)
        if spec.path in wrong:
            yield Verdict(spec, error=wrong[spec.path])
        elif isinstance(found, GaitsimError):
            yield Verdict(spec, error=found)
        elif found is not None:
            before = known[spec.path]
            now = [_row(spec, i, [outcome]) for i, (outcome,) in enumerate(found)]
            differs = tuple(differences(before.runs, now))
            yield Verdict(spec, differs, changes(before.made_from, spec.made_from()) if differs else ())


def changes(before: MadeFrom, now: MadeFrom) -> tuple[str, ...]:
    """What has changed in the files that a model is made from, in words."""
    found = [word for word in ("spec", "tuned") if getattr(before, word) != getattr(now, word)]
    names = {"spec": "the spec", "tuned": "its tuned values"}
    both = {**before.components, **now.components}
    components = [
        f"{reference} {before.components.get(reference, 'not there')} -> {now.components.get(reference, 'not there')}"
        for reference in sorted(both)
        if before.components.get(reference) != now.components.get(reference)
    ]
    return (*(names[word] for word in found), *components)


Ran = list[tuple[Outcome, ...]]


def _run(
    specs: Sequence[Archived], nudges: Sequence[float], listener: Listener
) -> Iterator[tuple[Archived, Ran | GaitsimError]]:
    """The outcomes of all runs of specs, for each change of gravity, or the error of a spec. All run in parallel."""
    calls = []
    prepared: dict[Archived, int | GaitsimError] = {}
    report = listener.progress("models prepared")
    for count, spec in enumerate(specs, start=1):
        try:
            simulators = [Simulator(_nudged(model, nudge)) for model in spec.models for nudge in nudges]
            prepared[spec] = len(simulators)
            calls += [simulator.run for simulator in simulators]
        except GaitsimError as error:
            prepared[spec] = error
        report(count, len(specs))
    report = listener.progress("runs")
    outcomes = in_threads(calls, cores())
    done = 0
    for spec in specs:
        ready = prepared[spec]
        if isinstance(ready, GaitsimError):
            yield spec, ready
            continue
        mine = []
        for _ in range(ready):
            mine.append(next(outcomes))
            done += 1
            report(done, len(calls))
        yield spec, list(zip(*[iter(mine)] * len(nudges), strict=True))


def _nudged(model: Model, share: float) -> Model:
    """The model with a slightly different gravity."""
    simulate = replace(model.simulate, gravity=model.simulate.gravity * (1 + share))
    return replace(model, simulate=simulate) if share else model


def _written(spec: Archived, path: Path, found: Ran | GaitsimError) -> Recording:
    """Write the record of a spec if it differs from the present one.

    Raises:
        GaitsimError: The runs failed, or the record cannot be written.
    """
    if isinstance(found, GaitsimError):
        raise found
    rows = [_row(spec, i, outcomes) for i, outcomes in enumerate(found)]
    now = Recorded(made_from=spec.made_from(), runs=rows)
    try:
        before = read_record(spec.path)
    except BadRecord:
        before = None
    if before is not None:
        now = updated(before, now)
        if now == before:
            return Recording(spec, path, "unchanged")
    try:
        write_record(spec.path, now)
    except OSError as error:
        rule = f"the record cannot be written ({error.strerror or error})"
        raise CannotSave(f"{path}: {rule}; make room or rights there.") from error
    if before is None:
        return Recording(spec, path, "new")
    return Recording(spec, path, "changed", tuple(differences(before.runs, now.runs)))


def _row(spec: Archived, index: int, outcomes: Sequence[Outcome]) -> Row:
    """A run in the form of a record, made from its outcome and, for tolerances, from those under another gravity.

    Raises:
        SimulationFailed: A run fails.
    """
    first, settings = outcomes[0], spec.rows[index].settings
    if len(outcomes) > 1 and first.status == "failed":
        rule = f"this fails, and an archive contains only models that run: {first.reason}"
        raise SimulationFailed(Fault(rule, Mark(display_path(spec.path)), run_words(settings)))
    statuses = dict.fromkeys(outcome.status for outcome in outcomes)
    units = {STEPS: "1", SCORE: "1"} | spec.models[index].metrics
    numbers = [_numbers(outcome) for outcome in outcomes]
    values = {name: _value([each.get(name) for each in numbers], units[name]) for name in numbers[0]}
    return Row(settings=settings, status=OR.join(statuses), numbers=values)


def _numbers(outcome: Outcome) -> dict[str, float | None]:
    named: dict[str, float | None] = {STEPS: float(outcome.steps)}
    if outcome.score is not None:
        named[SCORE] = outcome.score
    return named | {name: finite(value) for name, value in outcome.metrics.items()}


def _value(found: Sequence[float | None], unit: str) -> Value:
    """A number with the tolerance that follows from the other runs."""
    value = found[0]
    if len({each is None for each in found}) > 1:
        return Value(value=value, unit=unit, tolerance=None)
    if value is None:
        return Value(value=None, unit=unit, tolerance=0.0)
    response = max(abs(float(each or 0.0) - value) for each in found)
    wide = max(_RELATIVE * abs(value), _RESPONSES * response, _ABSOLUTE)
    return Value(value=value, unit=unit, tolerance=_upwards(wide))


def _upwards(number: float) -> float:
    """A number with two digits that is not smaller than a given one, above 0."""
    step = 10.0 ** (math.floor(math.log10(number)) - 1)
    return float(f"{math.ceil(number / step - 1e-9) * step:.1e}")


def _specs_in(folder: Path) -> list[Path]:
    """The specs directly in a folder."""
    return [path for path in sorted(folder.glob("*.yaml")) if not path.stem.endswith(".tuned")]
