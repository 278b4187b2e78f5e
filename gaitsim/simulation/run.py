"""One simulation: a program and a candidate give an Outcome."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any, Literal

import numpy as np

from gaitsim.compiler.mjcf import assemble
from gaitsim.compiler.program import Floats, Program, measures
from gaitsim.components.load import function_of
from gaitsim.errors import InvalidComponent, InvalidSpec, SimulationFailed
from gaitsim.model import TERMS, Model, Objective, Part, metric_names, recorded_signals
from gaitsim.simulation.failure import raised_in
from gaitsim.simulation.loop_result import LoopResult
from gaitsim.simulation.outcome import Outcome, Trajectory
from gaitsim.simulation.physics import Physics
from gaitsim.simulation.python_loop import PythonLoop
from gaitsim.simulation.view import views
from gaitsim.units import parse_unit

Mode = Literal["rapid", "normal"]


class _Raised(Exception):
    """A measure or an objective raised an exception, which is the cause of this one."""

    def __init__(self, part: Part, function: str) -> None:
        super().__init__(part.address, function)
        self.part, self.function = part, function


def _called(part: Part, function: str, *arguments: Any) -> None:
    try:
        function_of(part.type.cls, function)(*arguments)
    except Exception as error:
        raise _Raised(part, function) from error


@dataclass
class Simulator:
    """Simulates candidates of one model. Prepared code is kept between runs; no state of a run is."""

    model: Model
    mode: Mode = "rapid"
    program: Program = field(init=False)

    def __post_init__(self) -> None:
        self.program = Program(self.model)
        self._factors = {name: parse_unit(unit).factor for name, unit in self.model.metrics.items()}
        self._loop = self._prepared()
        self._loop.prepare()

    def _prepared(self) -> Any:
        if self.mode == "normal":
            return PythonLoop(self.program)
        from gaitsim.simulation.native_loop import NativeLoop

        return NativeLoop(self.program)

    @property
    def xml(self) -> str:
        """The mechanics as MJCF, with everything that films show."""
        return assemble(self.model, self.model.values()).xml

    def run(self, candidate: Sequence[float] | None = None, recorded: bool = False) -> Outcome:
        """Simulate one candidate.

        Args:
            candidate: The values of `model.free` in its order, in SI; their starts by default.
            recorded: Whether to keep the trajectory.
        """
        began = time.perf_counter()
        simulate = self.model.simulate
        steps = max(1, round(simulate.duration / simulate.step))
        try:
            values = self.model.values(candidate)
            with np.errstate(all="ignore" if self.mode == "rapid" else "warn"):
                ending: LoopResult = self._loop.run(values, steps, recorded)
        except (SimulationFailed, InvalidSpec, InvalidComponent) as error:
            # The spec's own numbers were checked, so only a candidate can make an invalid model here.
            wall = time.perf_counter() - began
            return Outcome("failed", str(error), 0, simulate.step, {}, None, wall)
        metrics, score, failure = self._judged(ending, values)
        status, reason, level = "completed", "", ""
        if failure:
            status, reason = "failed", failure
        elif ending.stopped_by is not None:
            status, reason = "stopped", self.model.parts[ending.stopped_by].address
            level = self._level(ending.stopped_by, ending)
        trajectory = self._trajectory(ending.record) if ending.record is not None else None
        wall = time.perf_counter() - began
        return Outcome(status, reason, ending.steps, simulate.step, metrics, score, wall, trajectory, level)

    def posed(self) -> Physics:
        """The mechanics in the initial pose of the model's own numbers."""
        physics: Physics = self._loop.physics
        physics.pose(self.model.values())
        return physics

    def first_instant(self) -> dict[str, float]:
        """Every recorded signal at the first instant, at the model's own numbers, in SI; empty if the run fails
        there.
        """
        with np.errstate(all="ignore"):
            ending: LoopResult = self._loop.run(self.model.values(), 1, True)
        if ending.record is None or not len(ending.record):
            return {}
        return dict(zip(self.program.signals, map(float, ending.record[0]), strict=True))

    def stopped_at_once(self) -> tuple[Part, str] | None:
        """The measure that ends the run in its first two steps and why, such as forwards; None if none does."""
        with np.errstate(all="ignore"):
            ending: LoopResult = self._loop.run(self.model.values(), 2, False)
        if ending.stopped_by is None:
            return None
        return self.model.parts[ending.stopped_by], self._level(ending.stopped_by, ending)

    def _judged(self, ending: LoopResult, values: Sequence[float]) -> tuple[dict[str, float], float | None, str | None]:
        """Metrics and score, or the reason why there are none."""
        if ending.failure:
            return {}, None, ending.failure
        try:
            metrics = self._metrics(ending)
            return self._in_units(metrics), self._score(metrics, values), None
        except _Raised as error:
            part, function = error.part, error.function
            cause = error.__cause__
            assert isinstance(cause, Exception)
            return {}, None, raised_in(part, function, "the end", cause)

    def _metrics(self, ending: LoopResult) -> dict[str, float]:
        found: dict[str, float] = {}
        nothing = np.zeros(0)
        for i, part in measures(self.model):
            m = SimpleNamespace(**dict.fromkeys(part.type.metrics, math.nan))
            p, _, x, _ = views(self.program, i, ending.p, nothing, ending.x, nothing)
            _called(part, "finish", p, x, m)
            found |= {name: float(getattr(m, own)) for own, name in metric_names(part).items()}
        return found

    def _level(self, index: int, ending: LoopResult) -> str:
        """The name of the final value of a part's first state with levels; empty if it has none."""
        for name, state in self.model.parts[index].type.states.items():
            if state.levels:
                return state.levels[int(ending.x[self.program.states.place(index, name)])]
        return ""

    def _in_units(self, metrics: dict[str, float]) -> dict[str, float]:
        """Metrics in their declared units. Inside, all numbers are in SI."""
        return {name: value / self._factors[name] for name, value in metrics.items()}

    def _score(self, metrics: dict[str, float], values: Sequence[float]) -> float | None:
        """The cost; None without an objective, or if a metric makes it infinite or nan."""
        objective = self.model.objective
        if objective is None:
            return None
        cost = _cost(objective, metrics, values)
        return cost if math.isfinite(cost) else None

    def _trajectory(self, record: Floats) -> Trajectory:
        units = tuple(signal.unit for signal in recorded_signals(self.model))
        # Rounded, so that 3 steps of 0.1 ms are 0.0003 s and not 0.00030000000000000003 s.
        times = np.round(np.arange(len(record)) * self.model.simulate.step, 12)
        return Trajectory(times, self.program.signals, units, record)


def _cost(objective: Objective, metrics: Mapping[str, float], values: Sequence[float]) -> float:
    """The cost of metrics in SI, with its terms."""
    part = objective.part
    wired = {name: metrics[metric] for name, metric in objective.metrics.items()}
    constants = {name: values[index] for name, index in part.constants.items()}
    defaults = {n: parse_unit(d.unit).to_si(d.default) for n, d in part.type.inputs.items() if d.default is not None}
    numbers = {name: np.float64(values[part.numbers[name]]) for name in part.type.parameters}
    inputs = defaults | constants | wired
    if TERMS in part.type.inputs:
        inputs[TERMS] = constants.get(TERMS, 0.0) + sum(_cost(term, metrics, values) for term in objective.terms)
    u = SimpleNamespace(**{name: np.float64(value) for name, value in inputs.items()})
    y = SimpleNamespace(cost=math.nan)
    _called(part, "output", SimpleNamespace(**numbers), u, None, y)
    return float(y.cost)
