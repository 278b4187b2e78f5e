"""The rows of a cohort. Each is simulated alone, and tuned again for a limited time if it does not complete."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from gaitsim.components.find import Library
from gaitsim.errors import InvalidComponent, InvalidSpec
from gaitsim.optimization.algorithms import ALGORITHMS
from gaitsim.optimization.evaluation import Verdict
from gaitsim.results.bundle import Bundle
from gaitsim.results.cohort import Cohort, Row, cohort_of
from gaitsim.results.tuned import problem_of
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.simulation.starting import start_findings
from gaitsim.spec.resolve import resolve
from gaitsim.spec.schema import optimize_section
from gaitsim.text.document import MappingNode


@dataclass(frozen=True)
class RowVerdict(Verdict):
    """The result of a row.

    Attributes:
        evaluations: The number of evaluations of its search; 0 without a search.
        values: The tuned values that the search found, in SI by address; empty if the shipped ones are as good.
    """

    evaluations: int = 0
    values: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Rows:
    """The rows of a bundle. A candidate is the number of a row, from 0."""

    cohort: Cohort
    document: MappingNode
    library: Library
    name: str
    starts: Mapping[str, float]
    mode: Mode

    def verdict(self, x: Sequence[float]) -> RowVerdict:
        """Simulate a row. An invalid row fails, with the reason."""
        try:
            simulator = self._simulator(self.cohort.rows[int(x[0])])
        except (InvalidSpec, InvalidComponent) as error:
            return RowVerdict("failed", str(error), None, {}, 0.0, 0)
        outcome = simulator.run()
        if outcome.status == "completed" or not self.cohort.retune:
            return _verdict(outcome)
        return self._retuned(simulator, outcome)

    def _simulator(self, row: Row) -> Simulator:
        """Make the simulator of a row.

        Raises:
            InvalidSpec: The row is invalid.
            InvalidComponent: A component file breaks the contract.
        """
        model = resolve(row.document(self.document), self.library, self.name).started_at(self.starts)
        simulator = Simulator(model, self.mode)
        if findings := start_findings(simulator).impossible:
            raise InvalidSpec(findings)
        return simulator

    def _retuned(self, simulator: Simulator, first: Outcome) -> RowVerdict:
        """Search from the start until a candidate of a generation completes, or the evaluations are used up."""
        section, most = optimize_section(self.document), self.cohort.retune
        problem = problem_of(simulator.model, section.spread_factor)
        algorithm = ALGORITHMS[section.algorithm].make(problem, self.cohort.seed, section.population)
        best, chosen, tried = first, dict[str, float](), 0
        while tried < most and best.status != "completed" and not algorithm.stop():
            vectors = algorithm.ask()
            candidates = [problem.values(vector) for vector in vectors[: most - tried]]
            outcomes = [simulator.run(candidate) for candidate in candidates]
            tried += len(outcomes)
            for candidate, outcome in zip(candidates, outcomes, strict=True):
                if _rank(outcome) < _rank(best):
                    best = outcome
                    chosen = dict(zip((free.address for free in simulator.model.free), candidate, strict=True))
            if len(outcomes) == len(vectors):
                algorithm.tell(vectors, [_cost(outcome) for outcome in outcomes])
        return _verdict(best, tried, chosen)


def bundle_rows(bundle: Bundle, mode: Mode) -> Rows:
    """The rows of a bundle's cohort.

    Raises:
        InvalidSpec: The spec breaks a rule.
        InvalidComponent: A component file breaks the contract.
        BadResult: The cohort cannot be read.
    """
    document, library, starts = bundle.document(), bundle.library(), bundle.starts()
    # Components are compiled now, so that forked workers need not do it again.
    Simulator(resolve(document, library, bundle.name).started_at(starts), mode)
    return Rows(cohort_of(bundle), document, library, bundle.name, starts, mode)


def _rank(outcome: Outcome) -> tuple[bool, float]:
    """The rank of an outcome; lower is better. Completed runs come before all others."""
    return outcome.status != "completed", _cost(outcome)


def _cost(outcome: Outcome) -> float:
    return math.inf if outcome.score is None else outcome.score


def _verdict(outcome: Outcome, evaluations: int = 0, values: Mapping[str, float] | None = None) -> RowVerdict:
    metrics = {name: value if math.isfinite(value) else None for name, value in outcome.metrics.items()}
    seconds, steps = outcome.simulated_seconds, outcome.steps
    return RowVerdict(
        outcome.status, outcome.reason, outcome.score, metrics, seconds, steps, (), evaluations, values or {}
    )
