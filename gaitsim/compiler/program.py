"""A program: the layout of a model as tables of numbers, the same for rapid and normal mode."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gaitsim.compiler.graph import Call, schedule
from gaitsim.errors import Faults, SimulationFailed
from gaitsim.model import Connection, Model, Part, recorded_signals
from gaitsim.units import parse_unit

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

STARTING_ROUNDS = 3  # a fiber, its delayed length, the reflex and the activation are known after these


@dataclass(frozen=True)
class Layout:
    """The place of every part's fields in one of the tables p, u, x and y."""

    offsets: Integers
    fields: tuple[dict[str, int], ...]
    sizes: tuple[int, ...]
    size: int

    def place(self, part: int, name: str) -> int:
        """The index of one field in the table."""
        return int(self.offsets[part]) + self.fields[part][name]

    def slices(self, part: int, sizes: dict[str, int]) -> dict[str, int | slice]:
        """The indices of a part's fields by name; a slice for an array, whose size is given."""
        places: dict[str, int | slice] = {}
        for name in self.fields[part]:
            begin = self.place(part, name)
            places[name] = slice(begin, begin + sizes[name]) if name in sizes else begin
        return places

    def span(self, part: int) -> range:
        """The indices of all fields of one part."""
        begin = int(self.offsets[part])
        return range(begin, begin + self.sizes[part])


def _sizes(part: Part) -> tuple[dict[str, int], ...]:
    """The lengths of a part's arrays in the four tables."""
    states = {name: state.size for name, state in part.type.states.items() if state.size is not None}
    return {name: one.size for name, one in part.type.series.items()}, {}, states, {}


def _layout(sizes: Sequence[dict[str, int]]) -> Layout:
    offsets, fields, insides, total = [], [], [], 0
    for each in sizes:
        offsets.append(total)
        own, inside = {}, 0
        for name, size in each.items():
            own[name] = inside
            inside += size
        fields.append(own)
        insides.append(inside)
        total += max(inside, 1)
    return Layout(np.array(offsets, dtype=np.int64), tuple(fields), tuple(insides), total)


@dataclass(frozen=True)
class DelayLine:
    """A delayed connection: the output it reads, the number that is its delay, and its value before the start."""

    sender: int
    number: int
    initial: int | None


@dataclass(frozen=True)
class _Filling:
    """How a table is filled for a candidate: fixed numbers, and places for numbers of the model."""

    fixed: Floats
    places: Integers
    numbers: Integers

    @staticmethod
    def of(fixed: Floats, chosen: dict[int, int]) -> _Filling:
        """Make a filling from the fixed numbers, and the index of the number for each other place."""
        return _Filling(fixed, np.array(list(chosen), dtype=np.int64), np.array(list(chosen.values()), dtype=np.int64))

    def filled(self, values: Floats) -> Floats:
        """A new table, given all numbers of a candidate."""
        table = self.fixed.copy()
        table[self.places] = values[self.numbers]
        return table


@dataclass(frozen=True)
class Program:
    """A model with its order of calls and its tables. It is compiled once and runs any candidate."""

    model: Model

    @cached_property
    def index(self) -> dict[str, int]:
        return {part.address: i for i, part in enumerate(self.model.parts)}

    @cached_property
    def parameters(self) -> Layout:
        sizes = [{n: s.size for n, s in p.type.series.items()} for p in self.model.parts]
        return _layout([dict.fromkeys(p.type.parameters, 1) | s for p, s in zip(self.model.parts, sizes, strict=True)])

    @cached_property
    def inputs(self) -> Layout:
        return _layout([dict.fromkeys(p.type.inputs, 1) for p in self.model.parts])

    @cached_property
    def states(self) -> Layout:
        return _layout([{n: s.size or 1 for n, s in p.type.states.items()} for p in self.model.parts])

    @cached_property
    def outputs(self) -> Layout:
        return _layout([dict.fromkeys(p.type.outputs, 1) for p in self.model.parts])

    @cached_property
    def field_places(self) -> tuple[tuple[dict[str, int | slice], ...], ...]:
        """For each part, the places of its fields in the four tables p, u, x and y; a slice for an array."""
        layouts = (self.parameters, self.inputs, self.states, self.outputs)
        return tuple(
            tuple(layout.slices(i, sizes) for layout, sizes in zip(layouts, _sizes(part), strict=True))
            for i, part in enumerate(self.model.parts)
        )

    @cached_property
    def calls(self) -> tuple[Call, ...]:
        return schedule(self.model, [c for c in self.model.connections if self._delayed(c)])

    @cached_property
    def updates(self) -> tuple[int, ...]:
        """The parts with an `update`."""
        return tuple(i for i, p in enumerate(self.model.parts) if "update" in p.type.functions)

    @cached_property
    def guarded(self) -> tuple[int, ...]:
        """The parts with events."""
        return tuple(i for i, p in enumerate(self.model.parts) if p.guarded)

    @cached_property
    def stops(self) -> tuple[int, ...]:
        """The parts that may end the run."""
        return tuple(i for i, p in enumerate(self.model.parts) if p.measure and "stop" in p.type.outputs)

    @cached_property
    def delays(self) -> tuple[DelayLine, ...]:
        """The delay lines, in the order of their connections.

        Raises:
            InvalidSpec: A delay can be shorter than a step.
        """
        faults, lines = Faults(), []
        step = self.model.simulate.step
        for connection in self.model.connections:
            if not self._delayed(connection) or connection.delay is None:
                continue
            number = self.model.numbers[connection.delay]
            free = self.model.free[number.free] if number.free is not None else None
            low = free.low if free else self._starts[connection.delay]
            if low < step * (1 - 1e-9):
                move = f"begin tune at {step:g} s or above" if free else "write 0 s or a longer delay"
                rule = f"{low:g} s is shorter than one step of {step:g} s; {move}"
                faults.add(f"{rule}.", number.mark, number.address)
            sender = self.outputs.place(*self.port(connection.sender))
            lines.append(DelayLine(sender, connection.delay, connection.initial))
        faults.raise_if_any()
        return tuple(lines)

    @cached_property
    def senders(self) -> tuple[tuple[tuple[int, int], ...], ...]:
        """For each input, its senders as (output, delay line or -1)."""
        found: list[list[tuple[int, int]]] = [[] for _ in range(self.inputs.size)]
        line = 0
        for connection in self.model.connections:
            target = self.inputs.place(*self.port(connection.target))
            delayed = self._delayed(connection)
            found[target].append((self.outputs.place(*self.port(connection.sender)), line if delayed else -1))
            line += delayed
        return tuple(tuple(each) for each in found)

    @cached_property
    def signals(self) -> tuple[str, ...]:
        """The addresses of all recorded signals."""
        return tuple(signal.address for signal in recorded_signals(self.model))

    @cached_property
    def signal_places(self) -> Integers:
        """The index of each signal in the table of outputs, continued by the table of states."""
        found = []
        for signal in recorded_signals(self.model):
            part, name = self.port(signal.address)
            of_states = name in self.model.parts[part].type.states
            place = self.outputs.size + self.states.place(part, name) if of_states else self.outputs.place(part, name)
            found.append(place)
        return np.array(found, dtype=np.int64)

    def port(self, address: str) -> tuple[int, str]:
        """The part and the name of a port."""
        owner, _, name = address.rpartition(".")
        return self.index[owner], name

    def part_of_output(self, place: int) -> int:
        """The part of an index in the table of outputs."""
        return int(np.searchsorted(self.outputs.offsets, place, side="right")) - 1

    def parameter_table(self, values: Floats) -> Floats:
        """The parameters of all parts.

        Args:
            values: All numbers of the model for a candidate, in SI.
        """
        return self._parameters_from.filled(values)

    @cached_property
    def _parameters_from(self) -> _Filling:
        fixed, chosen = np.zeros(self.parameters.size), {}
        for i, part in enumerate(self.model.parts):
            for name in part.type.parameters:
                if name in part.numbers:
                    chosen[self.parameters.place(i, name)] = part.numbers[name]
            for name, recording in part.series.items():
                begin = self.parameters.place(i, name)
                fixed[begin : begin + len(recording.values)] = recording.values
        return _Filling.of(fixed, chosen)

    def input_base(self, values: Floats) -> Floats:
        """The value of each input without its senders: a constant, or the default.

        Args:
            values: All numbers of the model for a candidate, in SI.
        """
        return self._base_from.filled(values)

    @cached_property
    def _base_from(self) -> _Filling:
        fixed, chosen = np.zeros(self.inputs.size), {}
        for i, part in enumerate(self.model.parts):
            for name, declared in part.type.inputs.items():
                place = self.inputs.place(i, name)
                if name in part.constants:
                    chosen[place] = part.constants[name]
                elif not self.senders[place] and declared.default is not None:
                    fixed[place] = parse_unit(declared.unit).to_si(declared.default)
        return _Filling.of(fixed, chosen)

    @cached_property
    def has_base(self) -> tuple[bool, ...]:
        """For each input, whether it has a constant or a default besides its senders."""
        found = self._base_from.fixed != 0
        found[self._base_from.places] = True
        return tuple(bool(each) for each in found)

    def delay_steps(self, values: Floats) -> Floats:
        """The delay of each delay line in steps. Values within rounding of an integer become that integer.

        Args:
            values: All numbers of the model for a candidate, in SI.

        Raises:
            SimulationFailed: An expression makes a delay shorter than a step.
        """
        step = self.model.simulate.step
        steps = np.array([values[line.number] / step for line in self.delays])
        whole = np.round(steps)
        steps = np.where(np.abs(steps - whole) < 1e-9 * np.maximum(whole, 1), whole, steps)
        for line, delay in zip(self.delays, steps, strict=True):
            if not delay >= 1:
                address = self.model.numbers[line.number].address
                rule = f"{values[line.number]:g} s is shorter than one step of {step:g} s"
                raise SimulationFailed(f"{address}: {rule}")
        return steps

    def _delayed(self, connection: Connection) -> bool:
        """Whether a connection has a delay; a fixed delay of zero does not count."""
        if connection.delay is None:
            return False
        return self.model.varying[connection.delay] or self._starts[connection.delay] != 0

    @cached_property
    def _starts(self) -> list[float]:
        """Every number of the model at the start of a search."""
        return self.model.values()


def measures(model: Model) -> list[tuple[int, Part]]:
    """The parts that report metrics, with their indices."""
    return [(i, part) for i, part in enumerate(model.parts) if part.type.metrics]
