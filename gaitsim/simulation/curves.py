"""The curves of one component: the declared ones, or else its outputs over each of its inputs."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from gaitsim.compiler.program import Floats
from gaitsim.component import Curve, Output, Parameter
from gaitsim.components.checks.build import placed
from gaitsim.components.checks.check import class_functions
from gaitsim.components.checks.curve import TIME
from gaitsim.components.composite import ComponentFile, Composite
from gaitsim.components.describe import described
from gaitsim.components.load import function_of
from gaitsim.components.primitive import Primitive
from gaitsim.simulation.trial import Trial
from gaitsim.units import parse_unit

_POINTS = 401
_STEPS = 2000  # of a curve over time
# How far an undeclared curve goes, by the unit of the input.
_SPANS: Mapping[str, tuple[float, float]] = {"1": (-1.0, 2.0), "rad": (-np.pi / 2, np.pi / 2), "rad/s": (-10.0, 10.0)}


@dataclass(frozen=True)
class Axis:
    """The name and the unit of an axis."""

    name: str
    unit: str


@dataclass(frozen=True)
class Line:
    """One line of a graph, in the units of its axes."""

    label: str
    x: Floats
    y: Floats


@dataclass(frozen=True)
class Graph:
    """One panel: axes, lines, inputs over time, and values that had to be assumed."""

    name: str
    doc: str
    across: Axis
    up: Axis
    lines: tuple[Line, ...]
    meanwhile: tuple[Line, ...] = ()
    assumed: Mapping[str, str] = field(default_factory=dict)


def why_no_curves(component: ComponentFile) -> str:
    """Why a component has no curves, and where its behaviour can be seen."""
    if isinstance(component, Composite):
        inner = next(iter(described(component)["parts"].values()))["use"]
        return f"it is assembled of other parts; draw those: gaitsim library show {inner} --plot"
    if component.metrics:
        return "it watches a whole run and reports metrics of it, which are no curve; gaitsim run prints them"
    if "output" not in component.functions:
        seen = "gaitsim show SPEC --mjcf shows it, and gaitsim check SPEC --plot draws moment arms of paths"
        return f"it is mechanics alone, and MuJoCo computes all its numbers in a model; {seen}"
    return "its outputs stay as they are whatever comes in, at the defaults of its parameters; try others with --set"


def graphs(component: ComponentFile, settings: Mapping[str, float] | None = None) -> list[Graph]:
    """Compute the graphs of a component.

    Args:
        component: The component.
        settings: Values of its parameters in SI, by name.

    Returns:
        The graphs; none if the component has no curves.
    """
    if isinstance(component, Composite):
        return []
    if component.curves:
        return [_graph(component, name, curve, settings or {}) for name, curve in component.curves.items()]
    for curves in (_at_rest(component), _over_steps(component)):
        found = [_graph(component, name, curve, settings or {}) for name, curve in curves]
        shaped = [graph for graph in found if any(_has_shape(line) for line in graph.lines)]
        if shaped:
            return shaped
    return []


def _has_shape(line: Line) -> bool:
    """Whether a line is worth drawing: it is not flat, and at least half of its values are numbers."""
    known = line.y[np.isfinite(line.y)]
    return bool(len(known) > len(line.y) / 2 and np.ptp(known) > 0)


def _at_rest(kind: Primitive) -> Iterator[tuple[str, Curve]]:
    """Each output over each input, and over each number that MuJoCo sets."""
    if kind.metrics or "output" not in kind.functions:
        return
    build = class_functions(ast.parse(kind.text)).get("build")
    mechanical = (placed(build, Output, kind.cls.declarations) if build else None) or set()
    for output in (name for name in kind.outputs if name not in mechanical):
        for name in [*sorted(kind.dependencies[output]), *sorted(mechanical)]:
            span = _SPANS.get(_declared(kind, name).unit, (-1.0, 1.0))
            yield f"{output} over {name}", Curve(output, name, span, f"{output} over {name}, all else at its default.")


def _over_steps(kind: Primitive) -> Iterator[tuple[str, Curve]]:
    """Each output over time while all inputs step up and down."""
    if kind.metrics or "output" not in kind.functions:
        return
    steps = {name: (0.0, 1.0, 0.0) for name, one in kind.inputs.items() if one.default is None}
    for output in kind.outputs:
        yield output, Curve(output, TIME, (0.0, 1.0), f"{output} after steps of the inputs.", steps=steps)


def _graph(kind: Primitive, name: str, curve: Curve, settings: Mapping[str, float]) -> Graph:
    assumed = {n: _assumed(p) for n, p in kind.parameters.items() if p.default is None and n not in settings}
    assumed = {n: value for n, value in assumed.items() if n not in curve.at and _reads(kind, curve, n)}
    numbers = {n: parse_unit(kind.parameters[n].unit).to_si(v) for n, v in assumed.items()} | dict(settings)
    family = curve.each[1] if curve.each else (None,)
    lines: list[Line] = []
    for value in family:
        at = dict(curve.at) | ({curve.each[0]: value} if curve.each and value is not None else {})
        label = _family_label(kind, curve, value) if value is not None else ""
        x, y = _computed(kind, curve, {n: v for n, v in at.items() if n not in settings}, numbers)
        lines.append(Line(label, y, x) if curve.inverse else Line(label, x, y))
    across, up = _axes(kind, curve)
    meanwhile = tuple(_stepped(curve, n) for n in curve.steps)
    assumptions = {n: f"{v:g} {kind.parameters[n].unit}".removesuffix(" 1") for n, v in assumed.items()}
    return Graph(
        name, curve.doc, *((up, across) if curve.inverse else (across, up)), tuple(lines), meanwhile, assumptions
    )


def _family_label(kind: Primitive, curve: Curve, value: float) -> str:
    assert curve.each is not None
    name = curve.each[0]
    unit = _declared(kind, name).unit if curve.of in kind.outputs else "1"
    return f"{name} = {value:g} {unit}".removesuffix(" 1")


def _assumed(parameter: Parameter) -> float:
    """A value for a parameter without a default, in its unit."""
    low, high = parameter.bounds or (1.0, 1.0)
    return min(max(1.0, low), high)


def _reads(kind: Primitive, curve: Curve, parameter: str) -> bool:
    """Whether a curve may depend on a parameter."""
    function = _helper(kind, curve.of)
    return function is None or parameter in function.__code__.co_varnames[: function.__code__.co_argcount]


def _helper(kind: Primitive, name: str) -> Callable[..., Any] | None:
    """A function of the component's file; None for an output."""
    if name in kind.outputs:
        return None
    own = function_of(kind.cls, min(kind.functions))
    found: Callable[..., Any] = own.__globals__[name]
    return found


def _axes(kind: Primitive, curve: Curve) -> tuple[Axis, Axis]:
    if curve.of not in kind.outputs:
        return Axis(curve.over, curve.over_unit), Axis(curve.of, curve.unit)
    unit = "s" if curve.over == TIME else _declared(kind, curve.over).unit
    return Axis(curve.over, unit), Axis(curve.of, kind.outputs[curve.of].unit)


def _declared(kind: Primitive, name: str) -> Any:
    return kind.cls.declarations[name]


def _computed(
    kind: Primitive, curve: Curve, at: Mapping[str, float | str], numbers: Mapping[str, float]
) -> tuple[Floats, Floats]:
    """One line: abscissa and ordinate in the declared units."""
    if curve.of not in kind.outputs:
        return _of_function(kind, curve, at, numbers)
    held = {n: parse_unit(_declared(kind, n).unit).to_si(v) for n, v in at.items() if not isinstance(v, str)}
    trial = Trial(kind).put(dict(numbers) | held)
    trial.put({n: getattr(trial.p, word) for n, word in at.items() if isinstance(word, str)})
    over_time = curve.over == TIME
    x, y = (_over_time if over_time else _swept)(trial, curve)
    return x, y / parse_unit(kind.outputs[curve.of].unit).factor


def _of_function(
    kind: Primitive, curve: Curve, at: Mapping[str, float | str], numbers: Mapping[str, float]
) -> tuple[Floats, Floats]:
    function = _helper(kind, curve.of)
    assert function is not None
    given = Trial(kind).put(numbers).p
    wanted = function.__code__.co_varnames[: function.__code__.co_argcount]
    fixed = {n: getattr(given, n) for n in wanted if n in kind.parameters}
    fixed |= {n: getattr(given, v) if isinstance(v, str) else _in_si(kind, n, v) for n, v in at.items()}
    x = np.linspace(*curve.span, _POINTS)
    factor = parse_unit(curve.over_unit).factor
    with np.errstate(all="ignore"):
        y = [float(function(**(fixed | {curve.over: np.float64(value * factor)}))) for value in x]
    return x, np.array(y) / parse_unit(curve.unit).factor


def _in_si(kind: Primitive, name: str, value: float) -> float:
    """An argument of a function in SI. Parameters are given in their units, others in SI."""
    return parse_unit(kind.parameters[name].unit).to_si(value) if name in kind.parameters else value


def _swept(trial: Trial, curve: Curve) -> tuple[Floats, Floats]:
    """The output at rest over a range of what it depends on."""
    x = np.linspace(*curve.span, _POINTS)
    factor = parse_unit(_declared(trial.kind, curve.over).unit).factor
    y = np.full(len(x), np.nan)
    before = trial.copy()
    for i, value in enumerate(x):
        for mine, theirs in zip(trial.arrays, before.arrays, strict=True):
            mine[:] = theirs
        trial.put({curve.over: value * factor})
        if not trial.call("output", "normal"):
            y[i] = getattr(trial.y, curve.of)
    return x, y


def _over_time(trial: Trial, curve: Curve) -> tuple[Floats, Floats]:
    """The output over time while inputs take one value after the other."""
    x = np.linspace(*curve.span, _STEPS + 1)
    dt = float(x[1] - x[0])
    y = np.full(len(x), np.nan)
    inputs = {n: _stepped(curve, n).y * parse_unit(_declared(trial.kind, n).unit).factor for n in curve.steps}
    for i in range(len(x)):
        trial.put({n: values[i] for n, values in inputs.items()})
        if i == 0 and "start" in trial.kind.functions:
            trial.call("start", "normal")
        if "output" in trial.kind.functions and trial.call("output", "normal"):
            break
        y[i] = getattr(trial.y, curve.of)
        if "update" in trial.kind.functions and trial.call("update", "normal", dt):
            break
    return x, y


def _stepped(curve: Curve, name: str) -> Line:
    """An input over time: its values one after the other, for equal times."""
    x = np.linspace(*curve.span, _STEPS + 1)
    values = np.array(curve.steps[name], dtype=float)
    which = np.minimum((np.arange(len(x)) * len(values)) // len(x), len(values) - 1)
    return Line(name, x, values[which])
