"""The result of one run of a loop, before metrics are computed."""

from __future__ import annotations

from dataclasses import dataclass

from gaitsim.compiler.program import Floats


@dataclass(frozen=True)
class LoopResult:
    """The number of steps, the part that stopped the run, the reason of a failure, the tables of parameters and
    states, and the record.
    """

    steps: int
    stopped_by: int | None
    failure: str | None
    p: Floats
    x: Floats
    record: Floats | None
