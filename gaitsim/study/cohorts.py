"""Cohorts: one spec with many bodies and many devices. Each row is a run of its own, and is tuned again if it does
not complete.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.cluster.cohort import RowVerdict
from gaitsim.cluster.time_limits import TimeLimits
from gaitsim.errors import Fault, InvalidComponent, InvalidSpec, Mark, Usage
from gaitsim.model import Model
from gaitsim.optimization.evaluation import Candidate, Verdict
from gaitsim.results.bundle import COHORT, BadResult, Bundle
from gaitsim.results.cohort import Cohort, Row, cohort_of
from gaitsim.results.manifest import changed_versions, read_result
from gaitsim.results.rows import read_rows
from gaitsim.results.store import CannotSave
from gaitsim.simulation.batch import Invalid
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Mode
from gaitsim.spec.inheritance import without
from gaitsim.spec.schema import optimize_section
from gaitsim.spec.study import variants
from gaitsim.study.bodies import Body, bodies_in
from gaitsim.study.cohort_table import Cells, cells_of, write_cells
from gaitsim.study.listening import Listener
from gaitsim.study.opened import Opened
from gaitsim.study.opening import Opening
from gaitsim.study.saver import RunSaver
from gaitsim.study.workplace import Task, Workplace

if TYPE_CHECKING:
    import pandas

_TIME_LIMITS = TimeLimits()
_TABLE = "table.csv"


@dataclass(frozen=True)
class CohortRequest:
    """A request for a cohort: a table of bodies, values of devices as ADDRESS=VALUES, and how rows are tuned again.

    Attributes:
        retune: The number of evaluations for a row that does not complete; 0 tunes none.
        seed: The seed of each search; None for that of the spec.
        metrics: The metrics to draw.
    """

    bodies: Path
    vary: Sequence[str] = ()
    retune: int = 0
    seed: int | None = None
    metrics: Sequence[str] = ()

    def check(self) -> None:
        """Check the request before anything runs.

        Raises:
            Usage: It does not fit.
        """
        if self.retune < 0:
            raise Usage(f"--retune {self.retune}: a number of evaluations for each row, or 0 for none.")
        if self.seed is not None and self.seed < 0:
            raise Usage(f"--seed {self.seed}: the smallest value is 0.")


@dataclass(frozen=True)
class RowResult:
    """The result of a row: how it ended, the evaluations of its search, and the tuned values that the search found."""

    outcome: Outcome
    evaluations: int = 0
    values: Mapping[str, float] = field(default_factory=dict)

    @property
    def ending(self) -> str:
        """completed, retuned (it completes with values of its own), stopped, failed, killed or timeout."""
        return "retuned" if self.outcome.status == "completed" and self.evaluations else self.outcome.status


@dataclass
class CohortRuns:
    """The rows of a cohort, and the results of those that were run.

    Attributes:
        model: The model of the spec without changes.
        metrics: The metrics to draw.
        notices: Notices for the user.
        found: Results by the number of the row, from 0.
    """

    cohort: Cohort
    bundle: Bundle
    model: Model
    mode: Mode
    metrics: Sequence[str]
    saver: RunSaver
    notices: Sequence[str] = ()
    found: dict[int, RowResult] = field(default_factory=dict)

    @property
    def folder(self) -> Path | None:
        """The result folder; None if the rows were not saved."""
        return self.saver.folder

    @property
    def bodies(self) -> list[str]:
        """The names of the bodies."""
        return list(dict.fromkeys(row.body for row in self.cohort.rows))

    @property
    def counts(self) -> dict[str, int]:
        """The number of rows that ended in each way."""
        endings = [found.ending for found in self.found.values()]
        return {ending: endings.count(ending) for ending in sorted(set(endings))}

    def table(self) -> pandas.DataFrame:
        """A row for each body with each device, from 1; numbers are in the units of the headings."""
        import pandas

        cells = self.cells()
        index = pandas.RangeIndex(1, len(cells.rows) + 1, name="run")
        return pandas.DataFrame(cells.rows, index=index, columns=list(cells.columns))

    def cells(self) -> Cells:
        """The table of the rows that were run."""
        return cells_of(self.model, [(self.cohort.rows[i], self.found[i]) for i in sorted(self.found)])

    def run(self, workplace: Workplace, listener: Listener) -> None:
        """Run all rows, save each when it ends, and write the table and its figures.

        An error of saving is in `saver.error`.

        Args:
            workplace: Where rows are evaluated.
            listener: Receives progress.

        Raises:
            ClusterError: The workers are lost. The rows before are saved.
            KeyboardInterrupt: The rows before are saved.
        """
        report, rows = listener.progress("rows"), self.cohort.rows
        try:
            for i, found in self._endings(workplace, listener):
                self.found[i] = found
                more = {"body": rows[i].body, "evaluations": found.evaluations, "values": dict(found.values)}
                self.saver.add(rows[i].settings, found.outcome, more)
                report(len(self.found), len(rows))
        except BaseException:
            self._close("interrupted")
            raise
        self._close("complete")
        with self.saver.errors_kept():
            self._draw()

    def _endings(self, workplace: Workplace, listener: Listener) -> Iterator[tuple[int, RowResult]]:
        """The results of the rows that are not known yet, as they end."""
        missing = [Candidate(0, i, (float(i),)) for i in range(len(self.cohort.rows)) if i not in self.found]
        if not missing:
            return
        # A row may take the time of a whole search.
        time_limits = replace(_TIME_LIMITS, least=_TIME_LIMITS.least * (1 + self.cohort.retune))
        evaluator = workplace.evaluator(Task(self.bundle, self.mode, time_limits), listener.say)
        try:
            for evaluation, _, _ in evaluator(missing):
                yield evaluation.candidate.index, _found(evaluation.verdict, self.model.simulate.step)
        finally:
            evaluator.close()

    def _close(self, status: str) -> None:
        """Sort the saved rows, and write the table."""
        places = {_key(row.body, row.settings): i for i, row in enumerate(self.cohort.rows)}
        self.saver.arrange(lambda row: places[_key(row["body"], row["settings"])])
        if self.folder and self.found:
            with self.saver.errors_kept():
                write_cells(self.folder / _TABLE, self.cells())
        self.saver.close(status)

    def _draw(self) -> None:
        if self.folder is None:
            return
        from gaitsim.analysis.drawings.drawing import save
        from gaitsim.analysis.searches.cohort import Outline, cohort_figures

        found = [(row, self.found[i]) for i, row in enumerate(self.cohort.rows)]
        rows = [Outline(row.body, row.settings, each.ending, dict(each.outcome.metrics)) for row, each in found]
        try:
            save(cohort_figures(rows, self.metrics, self.model.metrics), self.folder / "figures")
        except OSError as error:
            raise CannotSave(f"{self.folder}: a figure cannot be written ({error.strerror or error}).") from error


def cohort_runs(opening: Opening, asked: CohortRequest, mode: Mode, root: Path | None) -> CohortRuns:
    """Prepare a cohort. Nothing is run yet.

    Args:
        opening: The spec.
        asked: The request.
        mode: Native code ("rapid") or plain Python ("normal").
        root: The folder of results; None saves nothing.

    Raises:
        Usage: The request does not fit.
        InvalidSpec: The spec or the table has faults; the error holds all of the table's.
        InvalidComponent: A component file breaks the contract.
        BadResult: The folder is not a result, or the result is damaged.
        Untrusted: The result has components that this machine does not trust.
    """
    asked.check()
    if opening.names_result:
        raise Usage(f"{opening.path} is a result; name a spec, or continue a cohort with --resume.")
    opened = opening.open()
    devices = _devices(opened, asked.vary)
    opened = replace(opened, document=without(opened.document, "study"))
    model = opened.model()
    _check_metrics(asked.metrics, model)
    _check_tunable(asked, model, opening.path)
    bodies = bodies_in(asked.bodies, opened, model)
    seed = optimize_section(opened.document).seed if asked.seed is None else asked.seed
    cohort = Cohort(tuple(_crossed(bodies, devices, asked.bodies)), asked.retune, seed)
    opened = replace(opened, more={COHORT: cohort.text()})
    others, faults = _models(opened, cohort, bodies)
    models = [model, *others]
    more = {"cohort": {"bodies": str(asked.bodies), "metrics": list(asked.metrics)}}
    saver = RunSaver(root, opened, models, mode, more=more)
    notices = [*dict.fromkeys([*opened.notices, *model.notices, *(f"warning: {fault}" for fault in faults)])]
    return CohortRuns(cohort, opened.bundle(models), model, mode, asked.metrics, saver, notices)


def resumed_cohort(opening: Opening) -> CohortRuns:
    """Open the cohort of a result to continue it. Its finished rows are not run again.

    Raises:
        Usage: The result is not that of a cohort, or was made with other versions.
        InvalidSpec: Its spec breaks a rule.
        InvalidComponent: A component file breaks the contract.
        BadResult: The folder is not a result, or the result is damaged.
        Untrusted: The result has components that this machine does not trust.
        Locked: Another process writes it.
        CannotSave: The folder cannot be written.
    """
    if not opening.names_result:
        rule = f"{opening.path} is a spec; name the result folder of the cohort"
        raise Usage(f"--resume: {rule}, such as results/2026-11-22-walking-3f9c.")
    if opening.settings or opening.folders:
        raise Usage(f"--resume: {opening.path} continues with its own settings; leave out --set and --library.")
    opened = opening.open()
    manifest, bundle = read_result(opening.path)
    cohort = cohort_of(bundle)
    changed = changed_versions(manifest)
    if changed:
        rule = f"it was made with other versions ({', '.join(changed)}), so it would not continue identically"
        raise BadResult(f"{opening.path}: {rule}; install those, or start again.")
    model, rows = opened.model(), read_rows(opening.path, incomplete=True)
    mode: Mode = "normal" if manifest["mode"] == "normal" else "rapid"
    saver = RunSaver(None, replace(opened, more={COHORT: bundle.files[COHORT]}), [model], mode)
    metrics = [name for name in manifest.get("cohort", {}).get("metrics", []) if name in model.metrics]
    runs = CohortRuns(cohort, bundle, model, mode, metrics, saver)
    places = {_key(row.body, row.settings): i for i, row in enumerate(cohort.rows)}
    for row in rows:
        place = places.get(_key(row.get("body"), row["settings"]))
        if place is None:
            rule = "a run in it is of no row of its cohort, so it was edited; restore it from a copy"
            raise BadResult(Fault(f"{rule}.", Mark(str(opening.path / "evaluations.jsonl"))))
        runs.found[place] = _recorded(row, model.simulate.step)
    saver.go_on(opening.path, rows)
    runs.notices = [f"resuming {opening.path}: {len(rows)} of {len(cohort.rows)} rows are in it"]
    return runs


def _devices(opened: Opened, vary: Sequence[str]) -> list[dict[str, str]]:
    """The settings of devices: the spec's own study combined with each --vary; one empty row if there is neither."""
    rows = variants(opened.document, vary)
    return [*{_key("", row.settings): row.settings for row in rows}.values()]


def _crossed(bodies: Sequence[Body], devices: Sequence[dict[str, str]], path: Path) -> Iterator[Row]:
    """Every body with every device.

    Raises:
        InvalidSpec: Both set the same address.
    """
    both = [address for address in bodies[0].settings if any(address in device for device in devices)]
    if both:
        rule = f"{', '.join(both)} is a column here and varied as well; leave it out of one of them"
        raise InvalidSpec(Fault(f"{rule}.", Mark(str(path))))
    for body in bodies:
        for device in devices:
            yield Row(body.name, body.settings | device, body.place)


def _models(opened: Opened, cohort: Cohort, bodies: Sequence[Body]) -> tuple[list[Model], list[Invalid]]:
    """The models of each body and of each device, whose components the bundle needs; and why some have none.

    Raises:
        InvalidSpec: None is valid; the error is that of the first.
        InvalidComponent: Likewise.
    """
    count = len(cohort.rows) // len(bodies)
    models, faults = list[Model](), list[Invalid]()
    for i, row in enumerate(cohort.rows):
        if i >= count and i % count:
            continue
        try:
            models.append(opened.model(row.document(opened.document)))
        except (InvalidSpec, InvalidComponent) as error:
            faults.append(error)
    if not models:
        raise faults[0]
    return models, faults


def _check_metrics(metrics: Sequence[str], model: Model) -> None:
    """Check that the metrics to draw exist.

    Raises:
        Usage: One does not.
    """
    from gaitsim.errors import did_you_mean

    for name in metrics:
        if name not in model.metrics:
            raise Usage(f"--metric {name}: there is no such metric. {did_you_mean(name, model.metrics)}")


def _check_tunable(asked: CohortRequest, model: Model, spec: Path) -> None:
    """Check that rows can be tuned, if that is asked for.

    Raises:
        InvalidSpec: The spec tunes nothing or has no objective.
    """
    if asked.retune and not (model.free and model.objective):
        lacks = "nothing is tuned in this spec" if model.objective else "this spec has no objective"
        raise InvalidSpec(Fault(f"{lacks}, so no row can be tuned again; leave out --retune.", Mark(str(spec))))


def _key(body: Any, settings: Mapping[str, str]) -> str:
    return repr((body, sorted(settings.items())))


def _found(verdict: Verdict, step: float) -> RowResult:
    metrics = {name: math.nan if value is None else value for name, value in verdict.metrics.items()}
    outcome = Outcome(verdict.status, verdict.reason, verdict.steps, step, metrics, verdict.score, 0.0)
    if isinstance(verdict, RowVerdict):
        return RowResult(outcome, verdict.evaluations, verdict.values)
    return RowResult(outcome)


def _recorded(row: Mapping[str, Any], step: float) -> RowResult:
    metrics = {name: math.nan if value is None else float(value) for name, value in row["metrics"].items()}
    outcome = Outcome(row["status"], row["reason"], row["steps"], step, metrics, row["score"], 0.0)
    return RowResult(outcome, int(row.get("evaluations", 0)), dict(row.get("values", {})))
