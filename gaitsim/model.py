"""The resolved model: every part, number and connection of a spec, in SI. A model is immutable."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from gaitsim.component import Input, Output
from gaitsim.components.primitive import Primitive
from gaitsim.errors import Fault, Mark, SimulationFailed
from gaitsim.text.expression import Expression
from gaitsim.units import Unit, parse_unit

WORLD = "world"
TERMS = "terms"  # the input of an objective that receives the costs of its terms


@dataclass(frozen=True)
class Number:
    """A number of the model: fixed, tuned (free), or computed from numbers before it.

    Attributes:
        unit: The unit in which it is written and shown; the value is in SI.
    """

    address: str
    unit: Unit
    value: float = math.nan
    free: int | None = None
    expression: Expression | None = None
    fraction_of: int | None = None
    source: str = ""
    mark: Mark | None = field(default=None, compare=False)


@dataclass(frozen=True)
class Free:
    """A tuned number: bounds, start and spread in SI, and every address that it sets.

    Attributes:
        unit: The unit in which it is written and shown.
    """

    address: str
    unit: Unit
    low: float
    high: float
    start: float
    spread: float
    source: str
    drives: tuple[str, ...]
    mark: Mark | None = field(default=None, compare=False)

    def moved(self, value: float, start: float, origin: str) -> str:
        """The warning for a start outside the bounds, which was moved to the nearer bound.

        Args:
            value: The start that was asked for, in SI.
            start: The bound that is used instead, in SI.
            origin: The file that the start comes from; empty if unknown.
        """
        asked = self.unit.shown(value) + (f" from {origin}" if origin else "")
        rule = f"{asked} is outside {self.unit.span(self.low, self.high)}, so it starts at {self.unit.shown(start)}"
        return f"warning: {self.address}: {rule}; widen tune, or tune it again."


@dataclass(frozen=True)
class Place:
    """A point relative to a frame; its three coordinates are numbers of the model."""

    frame: str
    at: tuple[int, int, int]


@dataclass(frozen=True)
class Recording:
    """The values of a series in SI, its column, its source, and the unit of its text."""

    values: tuple[float, ...]
    column: str = ""
    source: str = ""
    unit: str = "1"


@dataclass(frozen=True)
class Part:
    """A primitive component at its address in the model.

    Attributes:
        attachments: By attachment, the frame or the body that the part is fastened to.
        places: The coordinates of the attachments that lie beside a frame.
    """

    address: str
    type: Primitive
    numbers: Mapping[str, int]
    constants: Mapping[str, int]
    options: Mapping[str, str]
    attachments: Mapping[str, str]
    points: Mapping[str, Sequence[Place]]
    mirrored: bool
    measure: bool
    mark: Mark
    series: Mapping[str, Recording] = field(default_factory=dict)
    places: Mapping[str, Sequence[Place]] = field(default_factory=dict)

    @property
    def coordinates(self) -> tuple[int, ...]:
        """The indices of the numbers that place its points and its attachments beside frames."""
        named = (*self.points.values(), *self.places.values())
        return tuple(number for places in named for place in places for number in place.at)

    @property
    def guarded(self) -> bool:
        """Whether the part has events."""
        return "reset" in self.type.functions


@dataclass(frozen=True)
class Group:
    """A composite component at its address in the model.

    Attributes:
        before: The index of the first part that was made after it.
        file: The name of its file as messages show it.
    """

    address: str
    reference: str
    before: int
    mark: Mark
    file: str = ""


@dataclass(frozen=True)
class Connection:
    """A connection from an output to an input.

    Attributes:
        sender: The address of the output.
        target: The address of the input.
        made_by: The part that makes the connection; empty if the spec does.
    """

    sender: str
    target: str
    delay: int | None = None
    initial: int | None = None
    made_by: str = ""
    mark: Mark | None = field(default=None, compare=False)


@dataclass(frozen=True)
class Signal:
    """A number that is recorded at every instant. A state with levels has names for the values 0, 1, ..."""

    address: str
    unit: str
    doc: str
    levels: tuple[str, ...] = ()


@dataclass(frozen=True)
class KnownValue:
    """A metric's value that is known from elsewhere, in SI, and how far from it counts as the same.

    Attributes:
        unit: The one it is written in outside.
        tolerance: None where nothing is said.
    """

    what: str
    metric: str
    value: float
    unit: str
    tolerance: float | None
    source: str
    mark: Mark | None = field(default=None, compare=False)


@dataclass(frozen=True)
class Simulate:
    """The duration and the step of a simulation, in seconds."""

    duration: float
    step: float
    gravity: float
    integrator: str


@dataclass(frozen=True)
class Objective:
    """The component that computes the cost from metrics, with the metric for each of its inputs.

    Its terms are objectives too; their costs are added to its input `terms`.
    """

    part: Part
    metrics: Mapping[str, str]
    terms: tuple[Objective, ...] = ()

    @property
    def all(self) -> tuple[Objective, ...]:
        """The objective, its terms, and their terms."""
        return (self, *(inner for term in self.terms for inner in term.all))


@dataclass(frozen=True)
class Model:
    """Everything that a program is compiled from."""

    name: str
    numbers: tuple[Number, ...]
    free: tuple[Free, ...]
    parts: tuple[Part, ...]
    groups: tuple[Group, ...]
    connections: tuple[Connection, ...]
    initial: Mapping[str, int]
    objective: Objective | None
    simulate: Simulate
    notices: tuple[str, ...] = ()
    reproduces: tuple[KnownValue, ...] = ()
    dropped: frozenset[Mark] = frozenset()  # keys of the spec that a replaced component lacks

    def __repr__(self) -> str:
        return f"<Model {self.name}: {len(self.parts)} parts, {len(self.free)} tuned>"

    @property
    def start(self) -> list[float]:
        """The start of every tuned number, in SI. `gaitsim run` simulates these values."""
        return [free.start for free in self.free]

    def started_at(self, values: Mapping[str, float], origin: str = "") -> Model:
        """The same model with other starts.

        A start outside the bounds is moved to the nearer bound, and a notice says so.

        Args:
            values: Starts in SI by address; addresses that are not tuned are ignored.
            origin: The file that the starts come from.
        """
        free, moved = [], []
        for each in self.free:
            value = values.get(each.address, each.start)
            start = min(each.high, max(each.low, value))
            free.append(replace(each, start=start))
            if start != value:
                moved.append(each.moved(value, start, origin))
        return replace(self, free=tuple(free), notices=(*self.notices, *moved))

    def values(self, candidate: Sequence[float] | None = None) -> list[float]:
        """Compute every number of the model for a candidate.

        Args:
            candidate: The values of `free`, in its order and in SI; the starts by default.

        Returns:
            One value in SI for each of `numbers`.

        Raises:
            SimulationFailed: An expression has no value there.
        """
        chosen = self.start if candidate is None else candidate
        values = [*self._fixed]
        for i in (i for i, varies in enumerate(self.varying) if varies):
            values[i] = _value(self.numbers[i], values, chosen)
        return values

    @cached_property
    def varying(self) -> tuple[bool, ...]:
        """For each number, whether it differs between candidates: the tuned ones and all that depend on them."""
        found: list[bool] = []
        for number in self.numbers:
            read = [index for _, index in number.expression.names] if number.expression else []
            read += [number.fraction_of] if number.fraction_of is not None else []
            found.append(number.free is not None or any(found[index] for index in read))
        return tuple(found)

    @cached_property
    def _fixed(self) -> tuple[float, ...]:
        """The numbers that all candidates share; nan for the others."""
        values: list[float] = []
        for number, varies in zip(self.numbers, self.varying, strict=True):
            values.append(math.nan if varies else _value(number, values, ()))
        return tuple(values)

    def place(self, part: Part) -> Mark:
        """Where a spec chose a part. A part that the file of a composite chose has the place of the composite."""
        around = [group for group in self.groups if part.address.startswith(f"{group.address}.")]
        marks = (part.mark, *(group.mark for group in reversed(around)))
        return next((mark for mark in marks if mark.file not in {group.file for group in around}), part.mark)

    def fault(self, part: Part, rule: str) -> Fault:
        """A fault of a part at its place. Of an inner part of a composite, the rule names the line there too."""
        place = self.place(part)
        return Fault(rule if place == part.mark else f"{rule} It is written in {part.mark}.", place, part.address)

    @property
    def metrics(self) -> dict[str, str]:
        """The unit of every metric."""
        return metric_units(self.parts, self.connections)


def _value(number: Number, before: list[float], chosen: Sequence[float]) -> float:
    if number.expression is not None:
        try:
            value = number.expression.value(before)
        except (ArithmeticError, ValueError) as error:
            message = f"{number.address}: {number.expression.text} has no value here ({error})"
            raise SimulationFailed(message) from error
    else:
        value = number.value if number.free is None else float(chosen[number.free])
    return value if number.fraction_of is None else value * before[number.fraction_of]


def metric_names(part: Part) -> dict[str, str]:
    """The metrics of a measure: from the name within the component to the name in the outcome."""
    return {name: part.address if name == "value" else f"{part.address}.{name}" for name in part.type.metrics}


def headline_metrics(names: Collection[str]) -> list[str]:
    """The metrics with the name of their measure, and all metrics of a measure that has no such metric."""
    return [name for name in names if name.rpartition(".")[0] not in names]


def metric_units(parts: Sequence[Part], connections: Sequence[Connection]) -> dict[str, str]:
    """The unit of every metric.

    A metric with the unit `*` has the unit of the measured signal, or of the series that it is declared like.

    Args:
        parts: The parts of the model.
        connections: Its connections, which lead from the measured signals to the measures.

    Returns:
        Units by the name of the metric in the outcome.
    """
    units = {f"{p.address}.{n}": o.unit for p in parts for n, o in p.type.outputs.items()}
    inputs = {f"{p.address}.{n}": i.unit for p in parts for n, i in p.type.inputs.items()}
    measured = {c.target.rpartition(".")[0]: units[c.sender] for c in reversed(connections) if inputs[c.target] == "*"}
    found = {}
    for part in parts:
        for own, name in metric_names(part).items():
            declared = part.type.metrics[own]
            unit = measured.get(part.address, "*") if declared.unit == "*" else declared.unit
            found[name] = _like(part.series[declared.like].unit, unit) if declared.like in part.series else unit
    return found


def headed(metric: str, models: Iterable[Model]) -> str:
    """A metric as the heading of a column, such as `hop [m]`; a plain number has no unit.

    Args:
        metric: The name of the metric.
        models: The models that have it. If their units differ, the heading names all of them.
    """
    units = dict.fromkeys(unit for model in models if (unit := model.metrics.get(metric)))
    written = " or ".join(units)
    return metric if written in ("", "1") else f"{metric} [{written}]"


def _like(unit: str, other: str) -> str:
    """A unit, if it measures the same quantity as the other; else the other."""
    return unit if other == "*" or parse_unit(unit).dimension == parse_unit(other).dimension else other


def port_unit(part: Part, port: Input | Output, numbers: Sequence[Number]) -> str:
    """The unit of a port: its own, or that of the series or the number that it is declared like.

    Args:
        part: The part.
        port: The declaration.
        numbers: The numbers of the model.
    """
    if port.like in part.series:
        return part.series[port.like].unit
    number = part.numbers.get(port.like)
    return port.unit if number is None else numbers[number].unit.text


def recorded_signals(model: Model) -> tuple[Signal, ...]:
    """The signals of a trajectory: every output, and every state of one number except those of measures."""
    found = []
    for part in model.parts:
        place = part.address
        units = {name: port_unit(part, o, model.numbers) for name, o in part.type.outputs.items()}
        found += [Signal(f"{place}.{name}", parse_unit(units[name]).si, o.doc) for name, o in part.type.outputs.items()]
        if not part.measure:
            states = {name: s for name, s in part.type.states.items() if s.size is None}
            found += [Signal(f"{place}.{name}", parse_unit(s.unit).si, s.doc, s.levels) for name, s in states.items()]
    return tuple(found)
