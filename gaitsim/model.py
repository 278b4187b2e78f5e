"""A model: every part, number and connection of a spec, resolved to SI; it never changes."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from gaitsim.components.primitive import Primitive
from gaitsim.errors import Mark, SimulationFailed
from gaitsim.text.expression import Expression
from gaitsim.units import Unit, parse_unit

WORLD = "world"
TERMS = "terms"  # the input of an objective that the costs of its terms are added to


@dataclass(frozen=True)
class Number:
    """One number of the model: fixed, free (tuned), or computed from numbers before it.

    Attributes:
        unit: The one it is written in outside; inside, its value is in SI.
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
    """A tuned number: bounds, start and spread in SI, and every address it drives.

    Attributes:
        unit: The one it is written in outside.
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
        """What is said of a start that was outside the bounds."""
        said = self.unit.shown(value) + (f" from {origin}" if origin else "")
        rule = f"{said} is outside {self.unit.span(self.low, self.high)}, so it starts at {self.unit.shown(start)}"
        return f"warning: {self.address}: {rule}; widen tune, or tune it anew."


@dataclass(frozen=True)
class Place:
    """A point on a frame: three coordinates as numbers of the model."""

    frame: str
    at: tuple[int, int, int]


@dataclass(frozen=True)
class Recording:
    """The numbers of a series in SI, the column that they come from, who recorded it, and the unit of its text."""

    values: tuple[float, ...]
    column: str = ""
    source: str = ""
    unit: str = "1"


@dataclass(frozen=True)
class Part:
    """One primitive in its place.

    Attributes:
        attachments: The frame, or the body, that each is on.
        places: Of those that lie beside it, where.
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
        """The numbers that say where its points and its attachments beside a frame lie."""
        named = (*self.points.values(), *self.places.values())
        return tuple(number for places in named for place in places for number in place.at)

    @property
    def guarded(self) -> bool:
        """Whether it has events."""
        return "reset" in self.type.functions


@dataclass(frozen=True)
class Group:
    """One composite in its place; `before` is the index of the first part opened after it."""

    address: str
    reference: str
    before: int
    mark: Mark


@dataclass(frozen=True)
class Connection:
    """A signal's way from an output to an input; `made_by` a part if no spec wrote it."""

    sender: str
    target: str
    delay: int | None = None
    initial: int | None = None
    made_by: str = ""
    mark: Mark | None = field(default=None, compare=False)


@dataclass(frozen=True)
class Signal:
    """One number that is recorded at every instant; a state may have names for its values 0, 1, ..."""

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
    """How long and in which steps, in SI."""

    duration: float
    step: float
    gravity: float
    integrator: str


@dataclass(frozen=True)
class Objective:
    """The part that turns metrics into a cost: its input -> the address of a metric.

    Its terms are objectives themselves; their costs are added to its input `terms`.
    """

    part: Part
    metrics: Mapping[str, str]
    terms: tuple[Objective, ...] = ()

    @property
    def all(self) -> tuple[Objective, ...]:
        """It and its terms, and theirs."""
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
    dropped: frozenset[Mark] = frozenset()  # words of the spec that a swapped-in part lacks

    def __repr__(self) -> str:
        return f"<Model {self.name}: {len(self.parts)} parts, {len(self.free)} tuned>"

    @property
    def start(self) -> list[float]:
        """The values of the free numbers that `run` uses."""
        return [free.start for free in self.free]

    def started_at(self, values: Mapping[str, float], origin: str = "") -> Model:
        """The same model with other starts, in SI, matched by address.

        One outside its bounds starts at the nearer bound, and a notice says so; `origin` is where it comes from.
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
        """Every number for a candidate: the values of `free`, in its order.

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
        """Which numbers differ between candidates: tuned ones, and what is computed from them."""
        found: list[bool] = []
        for number in self.numbers:
            read = [index for _, index in number.expression.names] if number.expression else []
            read += [number.fraction_of] if number.fraction_of is not None else []
            found.append(number.free is not None or any(found[index] for index in read))
        return tuple(found)

    @cached_property
    def _fixed(self) -> tuple[float, ...]:
        """The numbers that all candidates share; nan where they differ."""
        values: list[float] = []
        for number, varies in zip(self.numbers, self.varying, strict=True):
            values.append(math.nan if varies else _value(number, values, ()))
        return tuple(values)

    @property
    def metrics(self) -> dict[str, str]:
        """Every metric and its unit."""
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
    """A measure's metrics: its own name -> the name in the outcome."""
    return {name: part.address if name == "value" else f"{part.address}.{name}" for name in part.type.metrics}


def headline_metrics(names: Collection[str]) -> list[str]:
    """Of metrics those that bear their measure's name, and all of a measure that has none such."""
    return [name for name in names if name.rpartition(".")[0] not in names]


def metric_units(parts: Sequence[Part], connections: Sequence[Connection]) -> dict[str, str]:
    """Every metric and its unit; one left open is that of the signal that is measured, or of the series it is like."""
    units = {f"{p.address}.{n}": o.unit for p in parts for n, o in p.type.outputs.items()}
    measured = {
        c.target.rpartition(".")[0]: units[c.sender]
        for c in reversed(connections)
        if _input_unit(c.target, parts) == "*"
    }
    found = {}
    for part in parts:
        for own, name in metric_names(part).items():
            declared = part.type.metrics[own]
            unit = measured.get(part.address, "*") if declared.unit == "*" else declared.unit
            found[name] = _like(part.series[declared.like].unit, unit) if declared.like in part.series else unit
    return found


def headed(metric: str, models: Iterable[Model]) -> str:
    """A metric as the heading of a column: hop [m], or speed for a plain number.

    Its unit is that of all the models; where they differ, as a measured signal does, all are named.
    """
    units = dict.fromkeys(unit for model in models if (unit := model.metrics.get(metric)))
    said = " or ".join(units)
    return metric if said in ("", "1") else f"{metric} [{said}]"


def _like(unit: str, other: str) -> str:
    """A unit, if it is one of the other's quantity; else the other."""
    return unit if other == "*" or parse_unit(unit).dimension == parse_unit(other).dimension else other


def recorded_signals(model: Model) -> tuple[Signal, ...]:
    """What a trajectory has: every output, and every state that is one number and no measure's."""
    found = []
    for part in model.parts:
        place = part.address
        found += [Signal(f"{place}.{name}", parse_unit(o.unit).si, o.doc) for name, o in part.type.outputs.items()]
        if not part.measure:
            states = {name: s for name, s in part.type.states.items() if s.size is None}
            found += [Signal(f"{place}.{name}", parse_unit(s.unit).si, s.doc, s.levels) for name, s in states.items()]
    return tuple(found)


def _input_unit(port: str, parts: Sequence[Part]) -> str:
    owner, _, name = port.rpartition(".")
    return next(p.type.inputs[name].unit for p in parts if p.address == owner)
