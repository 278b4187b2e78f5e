"""gaitsim run --draws: the same run with every tuned number a little different, and what becomes of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gaitsim.cli import console
from gaitsim.errors import Fault, InvalidSpec, Mark, Usage
from gaitsim.text.quantity import in_plain_letters
from gaitsim.units import UnknownUnit, parse_quantity

if TYPE_CHECKING:
    from gaitsim.analysis.searches.draws import Summary
    from gaitsim.model import Model
    from gaitsim.optimization.draws import Draws
    from gaitsim.simulation.outcome import Outcome

_WITHIN, _SEED = "1 %", 1


def draws_asked(
    count: int | None, within: str | None, seed: int | None, vary: Sequence[str], out: Path | None
) -> Draws | None:
    """What --draws, --within and --seed ask for; None if nothing. Errors: Usage, also for what goes not with them."""
    if count is None:
        for option, value in (("--within", within), ("--seed", seed)):
            if value is not None:
                raise Usage(f"{option} {value}: this is of --draws; say how many, such as --draws 10, or leave it out.")
        return None
    for name, number, least in (("draws", count, 1), ("seed", seed, 0)):
        if number is not None and number < least:
            raise Usage(f"--{name} {number}: this is at least {least}.")
    if vary:
        rule = "draws are of one spec, and --vary makes several"
        raise Usage(f"--draws {count}: {rule}; take one at a time, such as --set {vary[0].partition('=')[0]}=VALUE.")
    if out is not None:
        raise Usage("--out writes one trajectory; drop --draws, or write one draw of its result: --candidate NUMBER.")
    from gaitsim.optimization.draws import Draws

    return Draws(count, _share(_WITHIN if within is None else within), _SEED if seed is None else seed)


def drawn_models(models: Sequence[Model], draws: Draws, spec: Path) -> list[Model]:
    """The one model at each draw; what no draw changes is said.

    Errors: Usage if a study gave more models than one, InvalidSpec if nothing is tuned.
    """
    from gaitsim.results.tuned import problem_of

    if len(models) > 1:
        rule = f"draws are of one spec, and {spec} is a study of {len(models)} runs"
        raise Usage(f"--draws {draws.count}: {rule}; take one of its result with --candidate, or --set study=null.")
    (model,) = models
    if not model.free:
        rule = "nothing is tuned in this spec, so no draw differs"
        move = "give a value bounds, such as gain: {value: 1, tune: [0, 5]}"
        raise InvalidSpec(Fault(f"{rule}; {move}.", Mark(str(spec))))
    still = [free.address for free in model.free if free.start == 0]
    if still:
        console.say(f"these are 0, which no share of it changes: {', '.join(still)}")
    return [model.started_at(values) for values in draws.values(problem_of(model))]


def drawn_data(
    draws: Draws, model: Model, outcomes: Sequence[Outcome], each_run: Sequence[Mapping[str, Any]]
) -> dict[str, Any]:
    """What --json says of the draws around a model's starts, together and of each run."""
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
            {"draw": k, "values": drawn, **row} for k, (drawn, row) in enumerate(zip(values, each_run, strict=False), 1)
        ],
    }


def give_draws(draws: Draws, model: Model, outcomes: Sequence[Outcome]) -> None:
    """The table over all draws around a model's starts, and how many completed: on stdout."""
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
    numbers = (console.shown(number) for number in (each.mean, each.least, each.greatest))
    return name, *numbers, units.get(each.name, ""), *([str(each.count)] if counted else [])


def _summaries(outcomes: Sequence[Outcome]) -> list[Summary]:
    from gaitsim.analysis.searches.draws import summaries

    scores = [{} if outcome.score is None else {"score": outcome.score} for outcome in outcomes]
    return [*summaries([outcome.metrics for outcome in outcomes]), *summaries(scores)]


def _completed(outcomes: Sequence[Outcome]) -> int:
    return sum(outcome.status == "completed" for outcome in outcomes)


def _share(text: str) -> float:
    """A share such as "1 %" or 0.01. Errors: Usage."""
    try:
        quantity = parse_quantity(text)
    except UnknownUnit:
        quantity = None
    if quantity is not None and quantity.unit.text == "1" and quantity.value >= 1:
        raise Usage(f"--within {text}: without its sign this is {100 * quantity.value:g} %; write '{text.strip()} %'.")
    if quantity is None or not quantity.unit.dimension.plain or not 0 <= quantity.value <= 1:
        move = in_plain_letters(text) or "this is a share from 0 % to 100 %; write such as '1 %'."
        raise Usage(f"--within {text}: {move}")
    return quantity.value
