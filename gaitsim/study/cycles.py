"""Periodic gaits: the fixed point of a model's return map, found by Newton's method, and its eigenvalues."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gaitsim.compiler.program import Floats
from gaitsim.errors import Fault, InvalidSpec, SimulationFailed, Usage, did_you_mean
from gaitsim.model import Free, Model
from gaitsim.simulation.run import Mode, Simulator
from gaitsim.study.listening import Listener
from gaitsim.study.opening import Opening, only_row
from gaitsim.units import parse_unit

_INITIAL = "initial_"  # the prefix of parameters that a section returns to
_SECTION = "measure/section"
_SHIFT = 1e-5  # the change of a number at the start for derivatives of the map, in SI
_CLOSED = 1e-11  # the largest distance of a fixed point from its image, in SI
_ROUNDS = 30


@dataclass(frozen=True)
class Cycle:
    """A periodic gait.

    Attributes:
        start: The values in SI of parameters at its section, such as `initial_apex_height`.
        metrics: The signals of all sections after a whole cycle, in SI.
        units: The units in which they are shown.
        eigenvalues: The eigenvalues of the map, largest magnitude first.
        slopes: The derivatives of the map: a row for each number of the start.
        period: The time from section to section, in s.
        distance: How far one cycle leads from its start, in SI.
        runs: The number of simulations that were needed.
    """

    start: Mapping[str, float]
    metrics: Mapping[str, float]
    units: Mapping[str, str]
    eigenvalues: tuple[complex, ...]
    slopes: Floats
    period: float
    distance: float
    runs: int

    @property
    def stable(self) -> bool:
        """Whether small disturbances decay."""
        return max(map(abs, self.eigenvalues)) < 1

    def in_unit(self, name: str) -> float:
        """A number of the start or a metric in its shown unit."""
        return parse_unit(self.units[name]).of({**self.metrics, **self.start}[name])


@dataclass
class ReturnMap:
    """The map from the numbers at a section to those at its next passage.

    Attributes:
        names: Parameters of the spec.
        measures: For each, the section whose signal is its value at the next passage.
    """

    model: Model
    names: tuple[str, ...]
    measures: tuple[str, ...]
    mode: Mode = "rapid"
    runs: int = 0

    def __post_init__(self) -> None:
        stops = [f"{measure}.stop_after" for measure in self.measures[:1]]
        self._simulator = Simulator(_freed(self.model, [*self.names, *stops]), self.mode)

    def __call__(self, start: Floats) -> Floats:
        """Simulate to the next passage.

        Args:
            start: The numbers at this passage, in SI.

        Returns:
            The numbers at the next passage, in SI.

        Raises:
            SimulationFailed: There is no next passage.
        """
        found = self.metrics(start)
        return np.array([found[f"{measure}.first"] for measure in self.measures])

    def metrics(self, start: Floats, passages: int = 1) -> Mapping[str, float]:
        """All metrics of a run that ends at a passage, in SI. Raises the errors of a call."""
        self.runs += 1
        outcome = self._simulator.run([*self.model.start, *map(float, start), float(passages)])
        numbers = ", ".join(f"{name} = {value:.6g}" for name, value in zip(self.names, start, strict=True))
        if outcome.status == "failed":
            raise SimulationFailed(f"from {numbers}: {outcome.reason}")
        count = min(outcome.metrics[f"{measure}.passages"] for measure in self.measures)
        if count < passages:
            ended = outcome.reason if outcome.status == "stopped" else "the run ends"
            when = f"{ended} after {outcome.simulated_seconds:.4g} s"
            rule = f"from {numbers} there is no return to the section: {when}"
            raise SimulationFailed(f"{rule}; start nearer to a gait, or make the run longer.")
        units = self.model.metrics
        return {name: parse_unit(units[name]).to_si(value) for name, value in outcome.metrics.items()}

    def slopes(self, start: Floats) -> Floats:
        """The derivatives of the map, by central differences. Raises the errors of a call."""
        columns = []
        for i in range(len(start)):
            shift = np.zeros_like(start)
            shift[i] = _SHIFT
            columns.append((self(start + shift) - self(start - shift)) / (2 * _SHIFT))
        return np.array(columns).T


def cycle(opening: Opening, mode: Mode, listener: Listener, report: Callable[[int, int], None]) -> Cycle:
    """Find the periodic gait near the start of a spec.

    The spec has parameters `initial_NAME` and, for each, a `measure/section` of that NAME. The signal of the section at
    the next passage is what the parameter is at this one.

    Args:
        opening: The spec or result.
        mode: Native code ("rapid") or plain Python ("normal").
        listener: Receives notices.
        report: Receives the number of iterations of Newton's method, and the largest number.

    Raises:
        Usage: The spec has no such parameters.
        InvalidSpec: The spec breaks a rule.
        InvalidComponent: A component file breaks the contract.
        BadResult: The folder is not a result, or the result is damaged.
        Untrusted: The result has components that this machine does not trust.
        SimulationFailed: Newton's method finds no fixed point.
    """
    opened = opening.open()
    row = only_row(opened, opening.path)
    model = opened.model(row.document)
    for notice in dict.fromkeys([*opened.notices, *model.notices]):
        listener.say(notice)
    found = ReturnMap(model, *_pairs(model, str(opening.path)), mode)
    values = model.values()
    addresses = [number.address for number in model.numbers]
    return fixed_point(found, np.array([values[addresses.index(name)] for name in found.names]), report)


def fixed_point(of: ReturnMap, start: Floats, report: Callable[[int, int], None] = lambda done, count: None) -> Cycle:
    """Find the fixed point of a return map near a start, by Newton's method.

    Raises:
        SimulationFailed: It is not found.
    """
    for done in range(_ROUNDS):
        report(done, _ROUNDS)
        away = of(start) - start
        slopes = of.slopes(start)
        try:
            step = np.linalg.solve(slopes - np.eye(len(start)), -away).astype(np.float64)
        except np.linalg.LinAlgError:
            break
        if float(np.abs(away).max()) < _CLOSED:
            return _cycle(of, start, slopes, float(np.abs(away).max()))
        start = _next(of, start, step, away)
    numbers = ", ".join(f"{name} = {value:.6g}" for name, value in zip(of.names, start, strict=True))
    rule = f"Newton's method finds no periodic gait; it came to {numbers}"
    raise SimulationFailed(f"{rule}; start nearer to one, with --set {of.names[0]}=VALUE.")


def _next(of: ReturnMap, start: Floats, step: Floats, away: Floats) -> Floats:
    """The start after a step of Newton's method. The step is shortened while it leads to no passage or farther away."""
    error = SimulationFailed("")
    for shorter in (1.0, 0.5, 0.25, 0.125, 0.0625):
        try:
            tried = start + shorter * step
            if shorter < 0.1 or np.abs(of(tried) - tried).max() < 2 * np.abs(away).max() + _CLOSED:
                return tried
        except SimulationFailed as failed:
            error = failed
    raise error


def _cycle(of: ReturnMap, start: Floats, slopes: Floats, distance: float) -> Cycle:
    eigenvalues = sorted((complex(each) for each in np.linalg.eigvals(slopes)), key=lambda e: (-abs(e), -e.imag))
    # After the second passage, contact times, speeds and the like belong to a whole cycle.
    found = of.metrics(start, 2)
    metrics = {name: found[name] for name in _sections(of.model)}
    period = of.metrics(start)[f"{of.measures[0]}.period"]
    named = dict(zip(of.names, map(float, start), strict=True))
    units = {number.address: number.unit.text for number in of.model.numbers if number.address in of.names}
    units |= {name: of.model.metrics[name] for name in metrics}
    return Cycle(named, metrics, units, tuple(eigenvalues), slopes, period, distance, of.runs)


def _pairs(model: Model, path: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The parameters `initial_NAME` of the spec, and the sections of that NAME.

    Raises:
        Usage: There are none, or one lacks its section.
    """
    sections = _sections(model)
    known = {number.address for number in model.numbers}
    names = [name for name in sections if f"{_INITIAL}{name}" in known]
    if not names:
        rule = f"{path} has no parameter {_INITIAL}NAME with a measure NAME of {_SECTION}"
        raise Usage(f"{rule}, between which a gait could be followed; add both.")
    lost = [each for each in known if each.startswith(_INITIAL) and each.removeprefix(_INITIAL) not in names]
    if lost:
        wanted = lost[0].removeprefix(_INITIAL)
        hint = did_you_mean(wanted, sections)
        raise Usage(f"{path}: {lost[0]} has no measure {wanted} of {_SECTION} that it could return to. {hint}")
    return tuple(f"{_INITIAL}{name}" for name in names), tuple(names)


def _sections(model: Model) -> list[str]:
    return [part.address for part in model.parts if part.measure and part.type.reference == _SECTION]


def _freed(model: Model, addresses: Sequence[str]) -> Model:
    """The model with additional free numbers, which are the last ones, in this order.

    Raises:
        InvalidSpec: One is not a plain number.
    """
    numbers, free = [*model.numbers], [*model.free]
    at = {number.address: i for i, number in enumerate(model.numbers)}
    values = model.values()
    for address in addresses:
        number = numbers[at[address]]
        if number.free is not None or number.expression is not None:
            rule = "a cycle is followed from a plain number; this is tuned or computed; write a number"
            raise InvalidSpec(Fault(f"{rule}.", number.mark, address))
        numbers[at[address]] = replace(number, free=len(free))
        start = values[at[address]]
        free.append(Free(address, number.unit, -math.inf, math.inf, start, 1.0, "", (address,)))
    return replace(model, numbers=tuple(numbers), free=tuple(free))
