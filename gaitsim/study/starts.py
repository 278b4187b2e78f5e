"""Checks of starts: unusual ones are reported, impossible ones are refused."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gaitsim.errors import InvalidSpec

if TYPE_CHECKING:
    from gaitsim.errors import Fault
    from gaitsim.simulation.run import Simulator
    from gaitsim.study.opened import Opened


class Starts:
    """Examines prepared simulators, and collects each unusual finding once."""

    def __init__(self, opened: Opened) -> None:
        # A result did run, so an unusual start does not prevent showing it.
        self._refuses = not opened.manifest
        self.unusual: list[Fault] = []

    def look_at(self, simulator: Simulator) -> None:
        """Examine the first instant of a model.

        Raises:
            InvalidSpec: A signal is outside its possible range.
        """
        from gaitsim.simulation.starting import start_findings

        findings = start_findings(simulator)
        if findings.impossible and self._refuses:
            raise InvalidSpec(findings.impossible)
        self.unusual += [f for f in (*findings.impossible, *findings.unusual) if f not in self.unusual]

    @property
    def warnings(self) -> list[str]:
        """The findings in words."""
        return [f"warning: {fault}" for fault in self.unusual]
