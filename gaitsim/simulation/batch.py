"""Several models at once: each in a thread of its own, since native code holds no lock."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from gaitsim.model import Model
from gaitsim.simulation.outcome import Outcome
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.simulation.threads import cores, in_threads


def run_all(
    models: Sequence[Model], mode: Mode, prepared: Callable[[Simulator], None] | None = None
) -> Iterator[Outcome]:
    """The outcomes of models, in their order; `prepared` sees each simulator before any runs.

    Errors: InvalidSpec, InvalidComponent, from the first model that does not compile.
    """
    # Prepared one after the other: compiling components is not for threads.
    simulators = []
    for model in models:
        simulators.append(Simulator(model, mode))
        if prepared:
            prepared(simulators[-1])
    return in_threads([simulator.run for simulator in simulators], cores())
