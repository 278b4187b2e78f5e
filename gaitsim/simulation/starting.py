"""Checks of the first instant: signals must lie in the ranges that components declare for the start."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from gaitsim.component import End
from gaitsim.components.checks.start_range import Ranged, end_in_si, units_of
from gaitsim.errors import Fault
from gaitsim.model import Model, Part
from gaitsim.simulation.idle import idle_perturbations
from gaitsim.simulation.initial_axes import singular_axes
from gaitsim.simulation.initial_depth import Sunk
from gaitsim.simulation.run import Simulator
from gaitsim.units import parse_unit


@dataclass(frozen=True)
class StartFindings:
    """Signals that are unusual at the start, and signals that are impossible."""

    unusual: tuple[Fault, ...] = ()
    impossible: tuple[Fault, ...] = ()


def start_findings(simulator: Simulator) -> StartFindings:
    """Compare the signals of the first instant with the declared ranges."""
    model, signals = simulator.model, simulator.first_instant()
    for connection in model.connections:
        if connection.sender in signals:
            signals[connection.target] = signals.get(connection.target, 0.0) + signals[connection.sender]
    physics = simulator.posed()
    sunk = Sunk(model, physics)
    values, starts = model.values(), list[_Start]()
    for index, part in enumerate(model.parts):
        numbers = {name: values[number] for name, number in part.numbers.items()}
        for name, declared in _ranged(part):
            address = f"{part.address}.{name}"
            if address in signals:
                depth = sunk if index in sunk.contacts else None
                start = _Start(model, part, address, declared, signals[address], numbers, depth)
                if start.beyond(declared.possible) or start.beyond(declared.usual):
                    starts.append(start)
    starts = _without_repetition(starts)
    impossible = [start.fault for start in starts if start.beyond(start.declared.possible)]
    unusual = [start.fault for start in starts if not start.beyond(start.declared.possible)]
    impossible += singular_axes(model, physics)
    unusual += idle_perturbations(model)
    if not impossible:
        unusual += _stopped(simulator)
    return StartFindings(tuple(unusual), tuple(impossible))


def _stopped(simulator: Simulator) -> Iterator[Fault]:
    """A run that a measure ends as it begins, such as one of a walker that starts fallen."""
    found = simulator.stopped_at_once()
    if found:
        part, how = found
        rule = f"this ends the run as it begins{f' ({how})' if how else ''}"
        move = "change initial:, or the numbers of this part"
        yield Fault(f"{rule}; {move}.", simulator.model.place(part), part.address)


def _without_repetition(starts: list[_Start]) -> list[_Start]:
    """The starts without those of contacts that one coordinate puts into the ground, but for the lowest of them."""
    below = [start for start in starts if start.sunk and start.sunk.move]
    lowest = min(below, key=lambda start: (not start.address.endswith(".height"), start.value), default=None)
    return [start for start in starts if start is lowest or start not in below]


def _ranged(part: Part) -> Iterator[tuple[str, Ranged]]:
    """The signals of a part that declare a range."""
    homes: list[Mapping[str, Ranged]] = [part.type.inputs, part.type.outputs, part.type.states]
    for name, declared in (item for home in homes for item in home.items()):
        if declared.usual or declared.possible:
            yield name, declared


@dataclass(frozen=True)
class _Start:
    """A signal at the start in SI, with its declaration and the numbers of its part."""

    model: Model
    part: Part
    address: str
    declared: Ranged
    value: float
    numbers: Mapping[str, float]
    sunk: Sunk | None  # for a contact of a model that starts below the ground

    def beyond(self, ends: tuple[End, End] | None) -> tuple[End, str] | None:
        """The end of a range that the value exceeds by more than rounding, and which end it is; None if it lies
        within.
        """
        if ends is None:
            return None
        rounding = 1e-9 * max(1.0, abs(self.value))
        if self.value < self._si(ends[0]) - rounding:
            return ends[0], "least"
        return (ends[1], "most") if self.value > self._si(ends[1]) + rounding else None

    @property
    def fault(self) -> Fault:
        clauses = [f"at the start this is {self._with_unit(self.value)}"]
        for word, ends in (("usual", self.declared.usual), ("possible", self.declared.possible)):
            passed = self.beyond(ends)
            if passed:
                end, side = passed
                origin = f" ({end})" if isinstance(end, str) else ""
                clauses.append(f"{word} is {self._with_unit(self._si(end))}{origin} at {side}")
        initial = self.model.initial.get(self.address)
        mark = self.model.place(self.part) if initial is None else self.model.numbers[initial].mark
        move = "change initial:, or the numbers of this part"
        if self.sunk and self.sunk.move:
            move, mark = self.sunk.move, self.sunk.mark or mark
        return Fault(f"{', '.join(clauses)}; {move}.", mark, self.address)

    def _si(self, end: End) -> float:
        return end_in_si(end, self.declared.unit, units_of(self.part.type.parameters), self.numbers)

    def _with_unit(self, number: float) -> str:
        """A number in SI as text with its unit; angles are in deg."""
        unit = self.declared.unit
        if parse_unit(unit).dimension == parse_unit("deg").dimension:
            unit = "deg"
        return f"{number / parse_unit(unit).factor:.4g}{'' if unit == '1' else f' {unit}'}"
