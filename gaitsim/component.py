"""The contract of a component file: declarations and small pure functions.

A component file holds one subclass of `Component`. Its class body declares parameters,
ports, states and parts; its static functions say what happens:

    start(p, u, x)           states once the whole model is posed
    output(p, u, x, y)       outputs of this instant
    update(p, u, x, y, dt)   states of the next instant; all inputs are of this instant
    reset(p, u, x, y, t)     states after an event: the instant t at which the output `guard` rose through 0
    finish(p, x, m)          metrics after the run (measures)
    build(p, mj)             bodies, joints, tendons ... in MuJoCo (physical parts)

p, u, x, y and m carry the declared parameters, inputs, states, outputs and metrics as
attributes: plain numbers in SI. Angles are in radians.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

__all__ = [
    "Attachment",
    "Component",
    "Curve",
    "Frame",
    "Input",
    "Link",
    "Metric",
    "Option",
    "Output",
    "Parameter",
    "Part",
    "Points",
    "Refused",
    "Series",
    "State",
    "StepLimit",
]


End = float | str  # of a range: a number in the unit, or an expression of parameters in SI


@dataclass(frozen=True)
class Parameter:
    """A number that a spec may set and tune. Bounds are in `unit`; without default it is required."""

    unit: str
    doc: str
    default: float | None = None
    bounds: tuple[float, float] | None = None
    source: str = ""


@dataclass(frozen=True)
class Points:
    """A list of places on segments: `[{on: shank, at: [-4 cm, 0 m, 30 %]}, ...]`, each number tunable."""

    doc: str
    unit: str = "m"


@dataclass(frozen=True)
class Series:
    """A recorded curve: `size` numbers at equal distances from 0 to 100 % of a cycle, which no search changes.

    A spec names a column of a table beside the components, or writes a list; either is
    brought to this size: `norms/fukuchi2018_walking.knee_flexion`, `[0 deg, 60 deg, 0 deg]`.
    """

    unit: str
    doc: str
    size: int


@dataclass(frozen=True)
class Option:
    """One word of a few. It shapes the part when the model is built and cannot be tuned."""

    doc: str
    choices: tuple[str, ...]
    default: str | None = None


@dataclass(frozen=True)
class Attachment:
    """A frame of another part that this one is fastened to, such as `parent: thigh.distal`."""

    doc: str


@dataclass(frozen=True)
class Frame:
    """A place on this part that others fasten to. A part with frames is a body of its own."""

    doc: str


@dataclass(frozen=True)
class Input:
    """A signal that comes in. `sums`: any number of senders (`to:`); else one (`from:`).

    Attributes:
        usual, possible: As of an output.
        like: The series, if there is one, whose unit must fit that of a signal that an input of the unit `*` takes.
    """

    unit: str
    doc: str
    default: float | None = None
    sums: bool = False
    usual: tuple[End, End] | None = None
    possible: tuple[End, End] | None = None
    like: str = ""


@dataclass(frozen=True)
class Output:
    """A signal that goes out.

    Attributes:
        usual: Where it is when a run starts, as a rule; a start elsewhere is warned of.
        possible: Where it can be at all; a start elsewhere is refused. Both are a low and a high end: numbers in
            `unit`, or expressions of parameters in SI, such as "upper + 0.1" of an angle.
    """

    unit: str
    doc: str
    usual: tuple[End, End] | None = None
    possible: tuple[End, End] | None = None


@dataclass(frozen=True)
class State:
    """What is remembered between steps: a number, `size` numbers, or one of named `levels`.

    Attributes:
        usual, possible: Of one number, as of an output.
    """

    unit: str = "1"
    doc: str = ""
    size: int | None = None
    levels: tuple[str, ...] = ()
    usual: tuple[End, End] | None = None
    possible: tuple[End, End] | None = None


@dataclass(frozen=True)
class Metric:
    """A number that a measure reports after the run. One named `value` bears the measure's own name.

    Attributes:
        unit: `*` for that of the signal that is measured.
        like: The series whose unit it has instead, if it is one of the same quantity: then both are in deg, although a
            joint's angle is in rad.
    """

    unit: str
    doc: str
    like: str = ""


@dataclass(frozen=True)
class Part:
    """A part inside this one, such as a muscle's path; a spec swaps it with `use:`.

    Attributes:
        reads: This part's input <- the inner part's output.
        sends: The inner part's input <- this part's input or output.
        gives: The inner part's parameter, if it has it and a spec does not set it <- an expression of this part's
            parameters.
        optional: It is there only if a spec says so.
    """

    kind: str
    doc: str
    default: str | None = None
    reads: tuple[tuple[str, str], ...] = ()
    sends: tuple[tuple[str, str], ...] = ()
    gives: tuple[tuple[str, str], ...] = ()
    optional: bool = False


@dataclass(frozen=True)
class Link:
    """Connections with another part that a spec makes by its name alone, such as `joint: ankle`.

    Attributes:
        reads: This part's input <- the other part's output.
        sends: The other part's input <- this part's output.
    """

    doc: str
    reads: tuple[tuple[str, str], ...] = ()
    sends: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class StepLimit:
    """The largest time step at which the component is right, found by measurement; `doc` says by which measure.

    `gaitsim check`, `run` and `optimize` say so of a spec whose step is longer.
    """

    unit: str
    doc: str
    value: float


@dataclass(frozen=True)
class Curve:
    """A graph of the component alone, which `gaitsim library show --plot` draws.

    Attributes:
        of: An output, or a function of this file.
        over: An input, a state, an output that MuJoCo sets, an argument of the function, or "time".
        span: The range of `over`, in its unit.
        at: Values of what else is read, by name, in their units; a word is the name of a parameter.
        each: A name and its values, one line for each.
        steps: Inputs over time: the values that each takes one after the other, for equal times.
        unit, over_unit: Of what a function gives and of its argument.
        inverse: The axes are exchanged.
    """

    of: str
    over: str
    span: tuple[float, float]
    doc: str
    at: Mapping[str, float | str] = field(default_factory=dict)
    each: tuple[str, tuple[float, ...]] | None = None
    steps: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    unit: str = "1"
    over_unit: str = "1"
    inverse: bool = False


Declaration = (
    Parameter
    | Points
    | Series
    | Option
    | Attachment
    | Frame
    | Input
    | Output
    | State
    | Metric
    | Part
    | Link
    | StepLimit
    | Curve
)


class Refused(ValueError):
    """Raised by a `build` whose numbers make no such part; the words go to the part's place in the spec."""


class Component:
    """The base of every component. What a subclass declares is read from its class body."""

    declarations: ClassVar[dict[str, Declaration]] = {}

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        own = {name: value for name, value in vars(cls).items() if isinstance(value, Declaration)}
        cls.declarations = {**cls.declarations, **own}
