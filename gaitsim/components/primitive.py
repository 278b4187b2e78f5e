"""A loaded component file: declarations, functions, and what is known of them."""

from __future__ import annotations

import inspect
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypeVar

from gaitsim import component as c
from gaitsim.components.checks.findings import Findings
from gaitsim.components.checks.shared import Shared, whole
from gaitsim.units import parse_unit, scaled

D = TypeVar("D")


@dataclass(frozen=True, eq=False)
class Primitive:
    """One Python component file.

    Attributes:
        digest: The digest of its text and of the shared files that it imports from.
    """

    reference: str
    path: Path
    display_path: str
    text: str
    digest: str
    cls: type[c.Component]
    findings: Findings
    functions: frozenset[str]
    shared: tuple[Shared, ...] = ()

    @property
    def dependencies(self) -> Mapping[str, frozenset[str]]:
        """The inputs that each output needs."""
        return self.findings.dependencies

    def declared(self, kind: type[D]) -> dict[str, D]:
        """The declarations of one class, in the order of the file."""
        return {n: d for n, d in self.cls.declarations.items() if isinstance(d, kind)}

    @cached_property
    def parameters(self) -> dict[str, c.Parameter]:
        return self.declared(c.Parameter)

    @cached_property
    def inputs(self) -> dict[str, c.Input]:
        return self.declared(c.Input)

    @cached_property
    def outputs(self) -> dict[str, c.Output]:
        return self.declared(c.Output)

    @cached_property
    def states(self) -> dict[str, c.State]:
        return self.declared(c.State)

    @cached_property
    def metrics(self) -> dict[str, c.Metric]:
        return self.declared(c.Metric)

    @cached_property
    def parts(self) -> dict[str, c.Part]:
        return self.declared(c.Part)

    @cached_property
    def links(self) -> dict[str, c.Link]:
        return self.declared(c.Link)

    @cached_property
    def frames(self) -> dict[str, c.Frame]:
        return self.declared(c.Frame)

    @cached_property
    def attachments(self) -> dict[str, c.Attachment]:
        return self.declared(c.Attachment)

    @cached_property
    def points(self) -> dict[str, c.Points]:
        return self.declared(c.Points)

    @cached_property
    def series(self) -> dict[str, c.Series]:
        return self.declared(c.Series)

    @cached_property
    def options(self) -> dict[str, c.Option]:
        return self.declared(c.Option)

    @cached_property
    def step_limits(self) -> dict[str, c.StepLimit]:
        return self.declared(c.StepLimit)

    @cached_property
    def curves(self) -> dict[str, c.Curve]:
        return self.declared(c.Curve)

    @property
    def largest_step(self) -> float:
        """The largest time step in seconds at which it is accurate; infinite if none was declared."""
        return min((scaled(d.value, parse_unit(d.unit).factor) for d in self.step_limits.values()), default=math.inf)

    @property
    def code(self) -> str:
        """The text of the shared files followed by that of the component."""
        return whole(self.text, self.shared)

    @property
    def kind(self) -> str:
        return self.reference.split("/")[0]

    @property
    def doc(self) -> str:
        return inspect.cleandoc(self.cls.__doc__ or "")

    @property
    def keys(self) -> list[str]:
        """The keys that an entry of a spec may have for this component."""
        kinds = c.Parameter | c.Input | c.Link | c.Attachment | c.Points | c.Series | c.Option | c.Part
        return list(self.declared(kinds))  # type: ignore[arg-type]
