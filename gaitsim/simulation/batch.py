"""Simulations of several models at once, each in a thread of its own. Native code holds no lock."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from gaitsim.errors import InvalidComponent, InvalidSpec
from gaitsim.model import Model
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.simulation.threads import cores, in_threads

Invalid = InvalidSpec | InvalidComponent


def run_all(
    models: Sequence[Model], mode: Mode, prepared: Callable[[Simulator], None] | None = None
) -> Iterator[Outcome]:
    """Simulate models.

    Args:
        models: The models.
        mode: Native code ("rapid") or plain Python ("normal").
        prepared: Is called with each simulator before any model runs.

    Returns:
        An iterator over the outcomes, in the order of the models.

    Raises:
        InvalidSpec: A model cannot be prepared.
        InvalidComponent: A component cannot become native code.
    """
    # Prepared one after the other, because compiling is not thread-safe.
    simulators = [_simulator(model, mode, prepared) for model in models]
    return in_threads([simulator.run for simulator in simulators], cores())


def run_each(
    models: Sequence[Model | Invalid], mode: Mode, prepared: Callable[[Simulator], None] | None = None
) -> Iterator[Outcome]:
    """Like `run_all`, for models of which some may be invalid. An invalid model has a failed outcome.

    Args:
        models: Models, or the error of an invalid one.
        mode: See `run_all`.
        prepared: See `run_all`.

    Returns:
        An iterator over the outcomes, in the order of the models.

    Raises:
        InvalidSpec: No model can run; the first error is raised.
        InvalidComponent: No model can run; the first error is raised.
    """
    made = [_simulator_or_fault(model, mode, prepared) for model in models]
    faults = [each for each in made if not isinstance(each, Simulator)]
    if len(faults) == len(made):
        raise faults[0]
    calls = [each.run if isinstance(each, Simulator) else partial(failed_by, each) for each in made]
    return in_threads(calls, cores())


def failed_by(fault: Invalid) -> Outcome:
    """The outcome of a run that could not begin."""
    return Outcome("failed", str(fault), 0, 0.0, {}, None, 0.0)


def _simulator(model: Model, mode: Mode, prepared: Callable[[Simulator], None] | None) -> Simulator:
    simulator = Simulator(model, mode)
    if prepared:
        prepared(simulator)
    return simulator


def _simulator_or_fault(
    model: Model | Invalid, mode: Mode, prepared: Callable[[Simulator], None] | None
) -> Simulator | Invalid:
    if not isinstance(model, Model):
        return model
    try:
        return _simulator(model, mode, prepared)
    except (InvalidSpec, InvalidComponent) as error:
        return error
