"""The fixed sections of a spec as pydantic models. The JSON Schema is derived from them."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, WithJsonSchema
from pydantic_core import PydanticCustomError

from gaitsim.errors import Faults, Mark, alternatives
from gaitsim.optimization.algorithms import ALGORITHMS, DEFAULT
from gaitsim.text.document import MappingNode, Node, SequenceNode, plain
from gaitsim.text.quantity import BadQuantity, example, needed, quantity_of
from gaitsim.text.spelling import respelled


def _quantity(unit: str, above: float | None = None) -> tuple[BeforeValidator, WithJsonSchema]:
    """The validator and the schema of a float in SI that is written with a unit."""

    def convert(value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise PydanticCustomError("quantity", "{text}", {"text": needed(unit).capitalize() + "."})
        try:
            quantity = quantity_of(value, unit)
        except BadQuantity as error:
            raise PydanticCustomError("quantity", "{text}", {"text": str(error)}) from error
        if above is not None and not quantity.value > above:
            text = f'"{value}" is not above {above:g}; {needed(unit)}.'
            raise PydanticCustomError("quantity", "{text}", {"text": text})
        return quantity.value

    schema = {"type": ["string", "number"], "examples": [example(unit)], "description": f"In {unit}."}
    return BeforeValidator(convert), WithJsonSchema(schema)


_SAMPLES = {
    "gaitsim": "1",
    "about": "Hopping in place.",
    "extends": "walk.yaml",
    "use_for": "{muscle: muscle/geyer2003}",
    "parameters": "{height: {unit: m, default: 1.8 m}}",
    "parts": "{thigh: {use: segment/rod, ...}}",
    "initial": "{knee.angle: 5 deg}",
    "measures": "{swing: {use: measure/range, ...}}",
    "objective": "{use: objective/minimize, value: {from: swing}}",
    "simulate": "{duration: 10 s, step: 1 ms}",
    "study": "[{feedback.gain: 2}, {feedback.gain: 3}]",
    "episodes": "[{noise.seed: 1}, {noise.seed: 2}]",
    "duration": "10 s",
    "step": "1 ms",
    "reproduces": "[{what: Height of a hop, metric: apex_height, value: 16.3 cm, source: geyer2003}]",
    "what": "Height of a hop",
    "metric": "apex_height",
    "value": "16.3 cm",
    "source": "geyer2003",
}
_SHARE = re.compile(r"0?\.\d+|[01]|1\.0*|0\.")  # a number from 0 to 1
_MOST_STEPS = 1e12  # days of computing; well within 64-bit integers


def _combination(value: object) -> str:
    """Check a way to combine scores: `mean`, `worst` or `quantile Q` with Q from 0 to 1."""
    text = " ".join(str(value).split()) if isinstance(value, str) else ""
    word, _, share = text.partition(" ")
    if text in ("mean", "worst") or (word == "quantile" and _SHARE.fullmatch(share)):
        return text
    problem = f'"{value}" is not a way' if isinstance(value, str | int | float) else "this is not a way"
    rule = f"{problem} to combine scores; write mean, worst, or such as quantile 0.9 (from 0 to 1)."
    raise PydanticCustomError("quantity", "{text}", {"text": rule})


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


_Seconds = Annotated[float, *_quantity("s", above=0)]
_Acceleration = Annotated[float, *_quantity("m/s^2")]


class SimulateSection(_Section):
    """Duration, step, gravity and integrator of a simulation."""

    duration: _Seconds = Field(description="Simulated time.")
    step: _Seconds = Field(description="Time step.")
    gravity: _Acceleration = Field(
        default=9.81, description="Gravitational acceleration, downwards. Geyer et al. 2003."
    )
    integrator: Literal["automatic", "euler", "implicitfast", "rk4"] = Field(
        default="automatic",
        description="euler is MuJoCo's semi-implicit Euler; implicitfast treats forces linear in velocity implicitly; "
        "automatic uses implicitfast if a part has such forces, else euler. rk4 is Runge-Kutta, with the forces of "
        "parts extrapolated within the step: of order 4 without forces of parts, else of order 2.",
    )


class SearchSection(_Section):
    """The settings of a search. Options of the command line replace them."""

    algorithm: str = Field(default=DEFAULT, description=f"Search algorithm: {alternatives(ALGORITHMS)}.")
    population: Annotated[int, Field(ge=2)] | None = Field(default=None, description="Candidates per generation.")
    generations: int = Field(default=100, ge=1, description="Largest number of generations.")
    seed: int = Field(default=1, ge=0, description="Seed of the search.")
    spread_factor: float = Field(
        default=1.0,
        gt=0,
        le=100,
        description="Factor on every spread. A factor below 1 keeps a search closer to its start.",
    )


class OptimizeSection(SearchSection):
    """The settings of a search, and the episodes in which candidates are simulated."""

    episodes: list[dict[str, Any]] = Field(
        default=[],
        description="Overrides. Each candidate is simulated once for each of them, such as seeds, pushes or slopes.",
    )
    combine: Annotated[str, BeforeValidator(_combination)] = Field(
        default="mean",
        description="How the scores of the episodes become one score: mean, worst, or a quantile such as quantile 0.9.",
    )


_Written = Annotated[Any, WithJsonSchema({"type": ["string", "number"], "examples": ["16.3 cm"]})]


class KnownRow(_Section):
    """A known value from elsewhere, and the metric to compare with it."""

    what: str = Field(description="What it is, in words.")
    metric: str = Field(description="The metric that is compared, such as apex_height.")
    value: _Written = Field(description="The known value, in a unit of the metric.")
    tolerance: _Written = Field(default=None, description="A difference up to which the metric counts as the same.")
    source: str = Field(description="A key of a references.bib, or definition: and words.")


class Header(_Section):
    """The fixed part of a spec. The entries of parts are checked against their components."""

    gaitsim: Literal[1] = Field(description="Version of the spec format.")
    about: str = Field(default="", description="What the model is, and its source.")
    extends: str = Field(default="", description="A spec to extend; its path is relative to this file.")
    use_for: dict[str, Any] = Field(
        default={},
        description="The component for all parts of a kind: kind/name, or {use: kind/name, ...} with parameters.",
    )
    parameters: dict[str, Any] = Field(default={}, description="Named numbers, which parts use as =name.")
    parts: dict[str, Any] = Field(description="The parts of the model, by name.", min_length=1)
    initial: dict[str, Any] = Field(default={}, description="Initial coordinates and states, by address.")
    measures: dict[str, Any] = Field(default={}, description="Measures that run with the simulation, by name.")
    objective: dict[str, Any] = Field(default={}, description="The component that computes a cost from the metrics.")
    simulate: SimulateSection = Field(description="Duration, time step and integrator.")
    optimize: OptimizeSection = Field(default=OptimizeSection(), description="How the parameters are tuned.")
    study: list[dict[str, Any]] = Field(default=[], description="A table of overrides. Each row is one run.")
    reproduces: list[KnownRow] = Field(
        default=[],
        description="Values that are known from elsewhere, such as published ones, beside the metrics that should have "
        "them. A spec does not inherit them.",
    )


_SECTIONS: dict[str, type[_Section]] = {"simulate": SimulateSection, "optimize": OptimizeSection}
_ROWS: dict[str, type[_Section]] = {"reproduces": KnownRow}


def optimize_section(document: MappingNode) -> OptimizeSection:
    """The section `optimize:` of a resolved document, with defaults."""
    section = document.entries.get("optimize")
    return OptimizeSection.model_validate(plain(section) if isinstance(section, MappingNode) else {})


def header(document: MappingNode, faults: Faults) -> tuple[Header | None, MappingNode]:
    """Check the fixed sections of a document.

    Args:
        document: The document.
        faults: Receives the faults.

    Returns:
        The header, which is None after faults, and the document with misspelt keys replaced.
    """
    document = respelled(document, Header.model_fields, "a spec has no key", faults)
    for name, model in _SECTIONS.items():
        section = document.entries.get(name)
        if isinstance(section, MappingNode):
            document = _with(document, name, respelled(section, model.model_fields, f"{name} has no key", faults))
    for name, model in _ROWS.items():
        rows = document.entries.get(name)
        if isinstance(rows, SequenceNode):
            items = (
                respelled(item, model.model_fields, f"a row of {name} has no key", faults, f"{name}.{i}")
                if isinstance(item, MappingNode)
                else item
                for i, item in enumerate(rows.items)
            )
            document = _with(document, name, SequenceNode(tuple(items), rows.mark))
    try:
        made = Header.model_validate({k: v for k, v in plain(document).items() if v is not None})
    except ValidationError as error:
        for detail in error.errors(include_url=False):
            _report(detail, document, faults)
        return None, document
    _check_steps(made.simulate, document, faults)
    return made, document


def _with(document: MappingNode, name: str, section: Node) -> MappingNode:
    """The document with one section replaced."""
    return MappingNode(document.entries | {name: section}, document.keys, document.mark)


def _check_steps(simulate: SimulateSection, document: MappingNode, faults: Faults) -> None:
    steps = simulate.duration / simulate.step
    if not 1 <= steps <= _MOST_STEPS:
        rule = f"a step of {simulate.step:g} s is longer than the duration, {simulate.duration:g} s"
        if steps > 1:
            rule = f"{simulate.duration:g} s are {steps:.3g} steps of {simulate.step:g} s; the limit is {_MOST_STEPS:g}"
        move = "write a shorter duration or a longer step" if steps > 1 else "write a shorter step"
        faults.add(f"{rule}; {move}.", _mark(document, ["simulate", "step"]), "simulate.step")


def _report(detail: Any, document: MappingNode, faults: Faults) -> None:
    """Add a fault of pydantic in our own words."""
    path = [word for word in detail["loc"] if word != "[key]"]
    address = ".".join(str(word) for word in path)
    name = str(path[-1])
    inside = {2: _SECTIONS, 3: _ROWS}.get(len(path), {})
    model = inside.get(str(path[0]), Header)
    field = model.model_fields.get(name)
    sample = f"{name}: {_SAMPLES[name]}" if field and name in _SAMPLES else ""
    mark = _mark(document, path)
    match detail["type"]:
        case "missing":
            about = ((field.description or "") if field else "").rstrip(".")
            faults.add(f"is missing ({about[:1].lower()}{about[1:]}); write {sample}.", mark, address)
        case "quantity":
            faults.add(detail["msg"], mark, address)
        case "literal_error" if path == ["gaitsim"]:
            faults.add(f'"{detail["input"]}" is not a version of this grammar; write gaitsim: 1.', mark, address)
        case "literal_error":
            choices = detail["ctx"]["expected"].replace("'", "")
            faults.add(f'"{detail["input"]}" is not offered; choose {choices}.', mark, address)
        case "too_short":
            faults.add(f"there is nothing in it; write {sample}.", mark, address)
        case "greater_than_equal":
            faults.add(f"{detail['input']} is too small; the smallest value is {detail['ctx']['ge']}.", mark, address)
        case "greater_than" | "less_than_equal":
            relations = {"gt": "above", "le": "at most"}
            (limit,) = (f"{relations[key]} {value:g}" for key, value in detail["ctx"].items() if key in relations)
            faults.add(f"{detail['input']} is out of range; this is {limit}.", mark, address)
        case "float_type" | "float_parsing":
            faults.add(f'"{detail["input"]}" is not a number; write {name}: 0.5.', mark, address)
        case "int_type" | "int_parsing" | "int_from_float":
            faults.add(f'"{detail["input"]}" is not a whole number; write {name}: 16.', mark, address)
        case kind:
            wanted = {"string_type": "a text", "list_type": "a list"}.get(kind, "a mapping of names")
            move = f"; write {sample}" if sample else ""
            faults.add(f"this needs {wanted}{move}.", mark, address)


def _mark(document: MappingNode, path: list[Any]) -> Mark:
    """The place of the deepest word of a path that the document has."""
    node: Node = document
    mark = document.mark
    for word in path:
        if isinstance(node, MappingNode) and word in node.entries:
            known_key, node = node.keys[word], node.entries[word]
            mark = known_key if isinstance(node, MappingNode | SequenceNode) else node.mark
        elif isinstance(node, SequenceNode) and isinstance(word, int) and word < len(node.items):
            node = node.items[word]
            mark = node.mark
        else:
            return mark
    return mark
