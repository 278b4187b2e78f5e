"""How one run of a loop ended, before metrics are made of it."""

from __future__ import annotations

from dataclasses import dataclass

from gaitsim.compiler.program import Floats


@dataclass(frozen=True)
class LoopResult:
    """Steps done, who stopped it, why it failed; the tables of parameters and states; the record."""

    steps: int
    stopped_by: int | None
    failure: str | None
    p: Floats
    x: Floats
    record: Floats | None
