"""Draws around the tuned values of a spec: their number, their size, and their models."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from gaitsim.errors import Fault, InvalidSpec, Mark, Usage
from gaitsim.text.quantity import in_plain_letters
from gaitsim.units import UnknownUnit, parse_quantity

if TYPE_CHECKING:
    from gaitsim.model import Model
    from gaitsim.optimization.draws import Draws

_WITHIN, _SEED = "1 %", 1


def draws_asked(
    count: int | None, within: str | None, seed: int | None, vary: Sequence[str], out: Path | None
) -> Draws | None:
    """Read --draws, --within and --seed.

    Returns:
        The draws; None if none are asked for.

    Raises:
        Usage: A value is wrong, or does not go with --vary or --out.
    """
    if count is None:
        for option, value in (("--within", within), ("--seed", seed)):
            if value is not None:
                raise Usage(f"{option} {value}: this needs --draws; add a number, such as --draws 10, or leave it out.")
        return None
    for name, number, least in (("draws", count, 1), ("seed", seed, 0)):
        if number is not None and number < least:
            raise Usage(f"--{name} {number}: the smallest value is {least}.")
    if vary:
        rule = "--draws applies to one spec, and --vary makes several"
        raise Usage(f"--draws {count}: {rule}; take one at a time, such as --set {vary[0].partition('=')[0]}=VALUE.")
    if out is not None:
        raise Usage("--out writes one trajectory; drop --draws, or write one draw of its result: --candidate NUMBER.")
    from gaitsim.optimization.draws import Draws

    return Draws(count, _share(_WITHIN if within is None else within), _SEED if seed is None else seed)


def drawn_models(models: Sequence[Model], draws: Draws, spec: Path) -> tuple[list[Model], list[str]]:
    """The models of all draws.

    Args:
        models: The model around which is drawn; a list with one model.
        draws: The draws.
        spec: The path of the spec, for messages.

    Returns:
        The models, and notices about values that no draw changes.

    Raises:
        Usage: There are several models, because the spec is a study.
        InvalidSpec: The spec tunes nothing.
    """
    from gaitsim.results.tuned import problem_of

    if len(models) > 1:
        rule = f"--draws applies to one spec, and {spec} is a study of {len(models)} runs"
        raise Usage(f"--draws {draws.count}: {rule}; take one of its result with --candidate, or --set study=null.")
    (model,) = models
    if not model.free:
        rule = "nothing is tuned in this spec, so no draw differs"
        move = "give a value bounds, such as gain: {value: 1, tune: [0, 5]}"
        raise InvalidSpec(Fault(f"{rule}; {move}.", Mark(str(spec))))
    still = [free.address for free in model.free if free.start == 0]
    notices = [f"these are 0, which no share of it changes: {', '.join(still)}"] if still else []
    return [model.started_at(values) for values in draws.values(problem_of(model))], notices


def _share(text: str) -> float:
    """Read a share such as "1 %" or 0.01.

    Raises:
        Usage: It is not a share.
    """
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
