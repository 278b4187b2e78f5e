"""gaitsim run --draws: runs with small random changes of every tuned number."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from gaitsim.cli import console

if TYPE_CHECKING:
    from gaitsim.analysis.searches.draws import Summary
    from gaitsim.model import Model
    from gaitsim.optimization.draws import Draws
    from gaitsim.simulation.outcome import Outcome


def drawn_data(
    draws: Draws, model: Model, outcomes: Sequence[Outcome], each_run: Sequence[Mapping[str, Any]]
) -> dict[str, Any]:
    """The draws as data for --json: a summary, and each run."""
    from gaitsim.results.tuned import problem_of

    units, values = model.metrics, draws.values(problem_of(model))
    return {
        "draws": asdict(draws),
        "completed": _completed(outcomes),
        "summary": {
            each.name: {
                "unit": units.get(each.name, "1"),
                "mean": each.mean,
                "least": each.least,
                "greatest": each.greatest,
                "draws": each.count,
            }
            for each in _summaries(outcomes)
        },
        "rows": [
            {"draw": k, "values": sample, **row}
            for k, (sample, row) in enumerate(zip(values, each_run, strict=False), 1)
        ],
    }


def give_draws(draws: Draws, model: Model, outcomes: Sequence[Outcome]) -> None:
    """Print the table over all draws, and how many completed."""
    found, units = _summaries(outcomes), model.metrics
    lacking = any(each.count < draws.count for each in found)
    rows = [_row(each, units, lacking) for each in found]
    if rows:
        console.give_table(["metric", "mean", "least", "greatest", "unit", *(["draws"] if lacking else [])], rows)
    tuned = len(model.free)
    numbers = f"all {tuned} tuned values" if tuned > 1 else "the tuned value"
    changed = f"{numbers} changed by up to {100 * draws.within:g} %, seed {draws.seed}"
    console.give(f"{_completed(outcomes)} of {draws.count} completed: {changed}")


def _row(each: Summary, units: Mapping[str, str], counted: bool) -> tuple[str, ...]:
    name = each.name if each.name in units else f"{each.name} (a cost)"
    numbers = (console.formatted(number) for number in (each.mean, each.least, each.greatest))
    return name, *numbers, units.get(each.name, ""), *([str(each.count)] if counted else [])


def _summaries(outcomes: Sequence[Outcome]) -> list[Summary]:
    from gaitsim.analysis.searches.draws import summaries

    scores = [{} if outcome.score is None else {"score": outcome.score} for outcome in outcomes]
    return [*summaries([outcome.metrics for outcome in outcomes]), *summaries(scores)]


def _completed(outcomes: Sequence[Outcome]) -> int:
    return sum(outcome.status == "completed" for outcome in outcomes)
