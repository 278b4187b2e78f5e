"""The search: ask for vectors, evaluate those that the journal does not have, tell their costs. Resuming is
replaying.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from gaitsim.optimization.algorithms import Algorithm
from gaitsim.optimization.evaluation import Candidate, Evaluation
from gaitsim.optimization.failures import Failures
from gaitsim.optimization.history import GenerationsFile, generation_of
from gaitsim.optimization.journal import Journal
from gaitsim.optimization.problem import Problem


class Evaluator(Protocol):
    """Evaluates candidates in any order.

    It yields the evaluation, its time in s, and the host. Workers begin when it is called, so the caller can do other
    work before it takes the first result.
    """

    def __call__(self, candidates: Sequence[Candidate]) -> Iterator[tuple[Evaluation, float, str]]: ...

    def close(self) -> None: ...


Watcher = Callable[["Progress"], None]


@dataclass
class Progress:
    """The state of a search.

    Attributes:
        generation, evaluations: The number of complete generations, and of their evaluations.
        asked, arrived: The number of candidates of the present generation, and of those that are evaluated.
        evaluated_now: The number of evaluations in this session.
        last: The evaluations of the last complete generation.
    """

    generation: int = 0
    evaluations: int = 0
    asked: int = 0
    arrived: int = 0
    evaluated_now: int = 0
    failed: int = 0
    failures: Failures = field(default_factory=Failures)
    best: Evaluation | None = None
    last: Sequence[Evaluation] = ()
    stop: str = ""


class Search:
    """One search in one result folder."""

    def __init__(
        self,
        problem: Problem,
        algorithm: Algorithm,
        evaluator: Evaluator,
        journal: Journal,
        generations: GenerationsFile,
        took: Callable[[Candidate, float, str], None],
        watch: Watcher,
    ) -> None:
        self.problem, self.algorithm, self.evaluator = problem, algorithm, evaluator
        self.journal, self.file, self.took, self.watch = journal, generations, took, watch
        self.progress = Progress()

    def run(self, generations: int) -> Progress:
        """Search until a number of generations is complete or the algorithm stops.

        All evaluations that arrived are in the journal, also after an error.

        Args:
            generations: The number of generations.

        Raises:
            DamagedJournal: The journal does not fit the search. Errors of the evaluator are raised too.
        """
        progress = self.progress
        # The first generation does not depend on the start, which alone would leave all workers but one idle.
        start = [Candidate(0, 0, tuple(self.problem.start))]
        while not progress.stop:
            if progress.generation >= generations:
                progress.stop = f"{generations} generations done"
                break
            vectors = self.algorithm.ask()
            number = progress.generation + 1
            asked = [Candidate(number, i, tuple(self.problem.values(vector))) for i, vector in enumerate(vectors)]
            evaluations = self._evaluated(start, asked) if number == 1 else self._evaluated(asked)
            self.algorithm.tell(vectors, [e.cost for e in evaluations])
            progress.stop = self.algorithm.stop() or ""
        self._close_last()
        return progress

    def _evaluated(self, *generations: Sequence[Candidate]) -> list[Evaluation]:
        """All evaluations of the last of some generations, in order: from the journal, or made now, all at once."""
        found: dict[Candidate, Evaluation] = {}
        for candidates in generations:
            known = self.journal.known(candidates)
            found |= {each: known[each.index] for each in candidates if each.index in known}
        candidates = [each for generation in generations for each in generation]
        self.progress.asked, self.progress.arrived = len(candidates), len(found)
        new = self.evaluator([each for each in candidates if each not in found])
        self._close_last()  # while the workers evaluate these
        for evaluation, seconds, where in new:
            self.journal.arrived(evaluation)
            self.took(evaluation.candidate, seconds, where)
            found[evaluation.candidate] = evaluation
            self.progress.arrived += 1
            self.progress.evaluated_now += 1
            self.watch(self.progress)
        for generation in generations:
            self._close_last()
            evaluations = [found[each] for each in generation]
            self._count(generation[0].generation, evaluations)
        return evaluations

    def _close_last(self) -> None:
        if self.progress.last:
            self.journal.close_generation(self.progress.last)

    def _count(self, generation: int, evaluations: list[Evaluation]) -> None:
        progress = self.progress
        progress.generation, progress.last = generation, evaluations
        progress.evaluations += len(evaluations)
        progress.asked = progress.arrived = 0
        for evaluation in evaluations:
            if evaluation.failed:
                progress.failed += 1
                progress.failures.add(evaluation)
            if progress.best is None or evaluation.cost < progress.best.cost:
                progress.best = evaluation
        best = progress.best.cost if progress.best else math.inf
        self.file.add(generation_of(generation, progress.evaluations, best, evaluations))
        self.watch(progress)
