"""Runs of a spec or result: one, one for each row of a study, or one for each draw."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from gaitsim.errors import GaitsimError, InvalidComponent, InvalidSpec, Usage
from gaitsim.model import Model
from gaitsim.spec.study import variants
from gaitsim.study.draws import drawn_models
from gaitsim.study.saver import RunSaver
from gaitsim.study.starts import Starts
from gaitsim.study.times import seconds_of

if TYPE_CHECKING:
    import pandas

    from gaitsim.optimization.draws import Draws
    from gaitsim.simulation.batch import Invalid
    from gaitsim.simulation.outcome import Outcome
    from gaitsim.simulation.run import Mode
    from gaitsim.spec.study import Variant
    from gaitsim.study.listening import Listener
    from gaitsim.study.opened import Opened
    from gaitsim.study.opening import Opening


_OTHER_FORMATS = (
    *(".parquet", ".feather", ".h5", ".hdf5", ".mat", ".nc", ".npy", ".npz", ".json", ".xlsx", ".ods"),
    *(".sto", ".mot", ".trc", ".c3d", ".mp4", ".gif", ".png", ".svg", ".pdf"),
)


@dataclass(frozen=True)
class Places:
    """Where runs are written.

    Attributes:
        results: The folder of results; None saves none.
        out: A CSV file for all signals of a single run.
        every: The time between two instants in `out`, such as '10 ms'; None for every step.
    """

    results: Path | None
    out: Path | None = None
    every: str | None = None

    def check(self) -> None:
        """Check before any simulation that the files can be written.

        Raises:
            CannotSave: The folder cannot be written.
        """
        out, results = self.out, self.results
        if out is None and results is None:
            return
        from gaitsim.results.store import CannotSave

        if out is not None and out.suffix.lower() in _OTHER_FORMATS:
            rule = f"--out writes CSV, and this name ends like another format ({out.suffix})"
            move = (
                f"name it {out.with_suffix('.csv')}, or save the run and use gaitsim analyze RESULT --export nc or sto"
            )
            raise CannotSave(f"{out}: {rule}; {move}.")
        if out is not None and out.is_dir():
            raise CannotSave(f"{out}: this is a folder; name a file in it, such as --out {out / 'trajectory.csv'}.")
        blocked = next((folder for folder in out.parents if folder.is_file()), None) if out is not None else None
        if blocked is not None:
            raise CannotSave(f"{out}: {blocked} is a file, so nothing can be written below it; choose another --out.")
        if results is not None and results.exists() and not results.is_dir():
            rule = "this is a file, and results go into a folder of that name"
            raise CannotSave(
                f"{results}: {rule}; rename the file, name another folder with --results, or use --no-save."
            )

    def spacing(self, models: Sequence[Model]) -> float | None:
        """The time between two instants in `out`, in s; None for every step.

        Raises:
            Usage: The request does not fit.
        """
        from gaitsim.simulation.outcome import steps_in

        spacing = seconds_of("--every", self.every)
        if spacing is not None:
            if self.out is None:
                rule = "this needs --out; name a file, such as --out run.csv, or leave it out"
                raise Usage(f"--every {self.every}: {rule}.")
            steps_in(spacing, models[0].simulate.step)
        return spacing


@dataclass
class Runs:
    """Runs and their outcomes so far.

    Attributes:
        rows: The settings of each run.
        models: The models of the valid rows; for draws, the one around which is drawn.
        simulated: The model of each run, or the error of an invalid one.
        notices: Notices for the user.
        outcomes: In the order of the rows.
    """

    rows: Sequence[Variant]
    models: Sequence[Model]
    simulated: Sequence[Model | Invalid]
    mode: Mode
    draws: Draws | None
    out: Path | None
    spacing: float | None
    starts: Starts
    saver: RunSaver
    notices: list[str]
    outcomes: list[Outcome] = field(default_factory=list)

    def __repr__(self) -> str:
        counts = Counter(outcome.status for outcome in self.outcomes)
        ended = ", ".join(f"{count} {status}" for status, count in counts.items()) or "none made yet"
        return f"<Runs of {self.models[0].name}: {ended}; {self.folder or 'not kept'}>"

    @property
    def single(self) -> bool:
        """Whether this is one run of the spec without changes."""
        return len(self.rows) == 1 and not self.rows[0].settings

    @property
    def folder(self) -> Path | None:
        """The result folder; None if the runs were not saved."""
        return self.saver.folder

    @property
    def unsaved(self) -> GaitsimError | None:
        """Why the runs or the signals could not be saved; None if they were."""
        return self.saver.error

    @property
    def failed(self) -> bool:
        """Whether every run failed."""
        return all(outcome.status == "failed" for outcome in self.outcomes)

    @property
    def warnings(self) -> list[str]:
        """Warnings about unusual starts."""
        return self.starts.warnings

    def table(self) -> pandas.DataFrame:
        """A row for each run, from 1: settings, status, reason, score (a cost), and metrics in their units."""
        import pandas

        rows = [
            {**row.settings, "status": o.status, "reason": o.reason, "score": o.score, **o.metrics}
            for row, o in zip(self.rows, self.outcomes, strict=False)
        ]
        return pandas.DataFrame(rows, index=pandas.RangeIndex(1, len(rows) + 1, name="run"))

    def run(self, listener: Listener) -> None:
        """Simulate all runs, and save each when it ends.

        An error of saving is in `unsaved`.

        Raises:
            InvalidSpec: The spec breaks a rule.
            InvalidComponent: A component file breaks the contract.
            KeyboardInterrupt: With the runs before it kept.
        """
        try:
            for row, outcome in zip(self.rows, self._outcomes(listener), strict=True):
                self.outcomes.append(outcome)
                self.saver.add(row.settings, outcome)
            self.saver.close()
        except KeyboardInterrupt:
            self.saver.close("interrupted")
            raise
        self._save_signals()

    def _outcomes(self, listener: Listener) -> Iterator[Outcome]:
        """The outcomes of the models, in their order, as they end."""
        from gaitsim.simulation.batch import run_each
        from gaitsim.simulation.run import Simulator

        if self.single:
            simulator = Simulator(self.models[0], self.mode)
            self.starts.look_at(simulator)
            self._warn(listener)
            with listener.waiting("simulating"):
                outcome = simulator.run(recorded=self.out is not None)
            yield outcome
            return
        report = listener.progress("runs")
        for count, outcome in enumerate(run_each(self.simulated, self.mode, self.starts.look_at), start=1):
            if count == 1:
                self._warn(listener)
            report(count, len(self.simulated))
            yield outcome

    def _warn(self, listener: Listener) -> None:
        for warning in self.warnings:
            listener.say(warning)

    def _save_signals(self) -> None:
        if self.out is None or self.outcomes[0].trajectory is None:
            return
        from gaitsim.results.store import save_trajectory

        with self.saver.errors_kept():
            (outcome,) = self.outcomes
            save_trajectory(self.out, outcome if self.spacing is None else outcome.every(self.spacing))


def prepared(
    opening: Opening, vary: Sequence[str], draws: Draws | None, mode: Mode, places: Places, listener: Listener
) -> Runs:
    """Prepare runs. Nothing is simulated yet.

    Args:
        opening: The spec or result.
        vary: Values to run, each as ADDRESS=VALUES.
        draws: The draws, if any.
        mode: Native code ("rapid") or plain Python ("normal").
        places: Where runs are written.
        listener: Receives notices.

    Raises:
        Usage: The request does not fit.
        InvalidSpec: The spec breaks a rule.
        InvalidComponent: A component file breaks the contract.
        BadResult: The folder is not a result, or the result is damaged.
        Untrusted: The result has components that this machine does not trust.
        CannotSave: The folder cannot be written.
    """
    opened = opening.open()
    rows = variants(opened.document, vary)
    if places.out is not None and len(rows) > 1:
        raise Usage("--out writes one trajectory; drop --vary or study:, or --set one value.")
    places.check()
    tried = [_model(opened, row) for row in rows]
    models = [each for each in tried if isinstance(each, Model)]
    faults = [each for each in tried if not isinstance(each, Model)]
    if faults and (draws or not models):
        raise faults[0]
    spacing = places.spacing(models)
    notices = list(dict.fromkeys([*opened.notices, *(notice for model in models for notice in model.notices)]))
    for notice in notices:
        listener.say(notice)
    simulated: Sequence[Model | Invalid] = tried
    if draws:
        simulated, unmoved = drawn_models(models, draws, opening.path)
        rows = rows * draws.count
        notices += unmoved
        for notice in unmoved:
            listener.say(notice)
    saver = RunSaver(places.results, opened, models, mode, draws)
    return Runs(rows, models, simulated, mode, draws, places.out, spacing, Starts(opened), saver, notices)


def _model(opened: Opened, row: Variant) -> Model | Invalid:
    """The model of a row, or the error of an invalid one."""
    try:
        return opened.model(row.document)
    except (InvalidSpec, InvalidComponent) as error:
        return error
