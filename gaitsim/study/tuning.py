"""A search with its result folder. It ends complete, or in a state from which it can continue."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gaitsim.cluster.timings import Timings
from gaitsim.errors import SimulationFailed, command
from gaitsim.model import Model
from gaitsim.optimization.algorithms import ALGORITHMS
from gaitsim.optimization.failures import reason_of
from gaitsim.optimization.history import GenerationsFile, parameters_csv
from gaitsim.optimization.journal import Journal, read
from gaitsim.optimization.problem import Problem
from gaitsim.optimization.search import Progress, Search
from gaitsim.results.bundle import Bundle
from gaitsim.results.lock import Lock
from gaitsim.results.manifest import FORMAT, write_manifest
from gaitsim.results.store import CannotSave, finish
from gaitsim.results.tuned import problem_of
from gaitsim.simulation.run import Mode
from gaitsim.study.workplace import Task, Workplace


@dataclass
class Tuning:
    """One search in its folder."""

    folder: Path
    manifest: dict[str, Any]
    bundle: Bundle
    model: Model
    notices: list[str]

    @property
    def problem(self) -> Problem:
        return problem_of(self.model, self.manifest["search"].get("spread_factor", 1.0))

    @property
    def generations(self) -> int:
        return int(self.manifest["search"]["generations"])

    @property
    def mode(self) -> Mode:
        return "normal" if self.manifest["mode"] == "normal" else "rapid"

    def run(self, workplace: Workplace, watch: Callable[[Progress], None], say: Callable[[str], None]) -> Progress:
        """Search. The folder is then complete, or interrupted with everything in its journal.

        Raises:
            Locked: Another process writes this result.
            CannotSave: The folder cannot be written.
            ClusterError: The cluster fails or cannot be reached.
            DamagedJournal: The journal is damaged.
        """
        try:
            with Lock(self.folder):
                progress = self._run_locked(workplace, watch, say)
        except OSError as error:
            reason = error.strerror or str(error)
            raise CannotSave(f"{self.folder}: the search cannot be written ({reason}); make room or rights.") from error
        self._refuse_if_all_failed(progress)
        return progress

    def _run_locked(
        self, workplace: Workplace, watch: Callable[[Progress], None], say: Callable[[str], None]
    ) -> Progress:
        try:
            with ExitStack() as closing:
                write_manifest(self.folder, self.manifest | {"status": "running"})
                work = self._search(closing, workplace, watch, say)
                progress = work.run(self.generations)
                self._finish(progress)
        except BaseException:
            with suppress(OSError):
                write_manifest(self.folder, self.manifest | {"status": "interrupted"})
            raise
        return progress

    def _search(
        self, closing: ExitStack, workplace: Workplace, watch: Callable[[Progress], None], say: Callable[[str], None]
    ) -> Search:
        """Make the search with its files, which are closed by `closing`."""
        asked = self.manifest["search"]
        journal = Journal(self.folder)
        closing.callback(journal.close)
        evaluator = workplace.evaluator(Task(self.bundle, self.mode), say)
        closing.callback(evaluator.close)
        rows, timings = GenerationsFile(self.folder), Timings(self.folder)
        closing.callback(rows.close)
        closing.callback(timings.close)
        algorithm = ALGORITHMS[asked["algorithm"]].make(self.problem, asked["seed"], asked["population"])
        return Search(self.problem, algorithm, evaluator, journal, rows, timings.add, watch)

    def discard_if_empty(self) -> bool:
        """Remove the folder if nothing was evaluated.

        Returns:
            Whether it was removed.
        """
        if any(read(self.folder)):
            return False
        shutil.rmtree(self.folder)
        return True

    def _finish(self, progress: Progress) -> None:
        best = progress.best.candidate.x if progress.best and not progress.best.failed else None
        table = parameters_csv(self.problem, best, progress.last)
        (self.folder / "parameters.csv").write_text(table, encoding="utf-8")
        score = progress.best.verdict.score if progress.best else None
        self.manifest = self.manifest | {
            "status": "complete",
            "format": FORMAT,
            "stop": progress.stop,
            "best_score": score,
            "evaluations": progress.evaluations,
            "failed": progress.failed,
        }
        headline = [
            f"best score {score}",
            f"{progress.evaluations} evaluations in {progress.generation} generations, {progress.failed} failed",
            f"stopped: {progress.stop}",
        ]
        finish(self.folder, self.manifest, headline)

    def _refuse_if_all_failed(self, progress: Progress) -> None:
        if progress.best is not None and not progress.best.failed:
            return
        count, example = progress.failures.most_common[0]
        rule = f"every one of {progress.evaluations} candidates failed; {count} because {reason_of(example)}"
        move = f"look at one: {command('run', self.folder, '--candidate', example.candidate.name)}"
        raise SimulationFailed(f"{self.folder}: {rule}; {move}")
