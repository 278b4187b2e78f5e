"""The contract of a component file: declarations and small pure functions.

A component file holds one subclass of `Component`. Its class body declares parameters,
ports, states and parts. Its static functions compute:

    start(p, u, x)           the states at the start, once the whole model is posed
    output(p, u, x, y)       the outputs of this instant
    update(p, u, x, y, dt)   the states of the next instant; all inputs are of this instant
    reset(p, u, x, y, t)     the states after an event: the instant t at which the output `guard` rose through 0
    finish(p, x, m)          the metrics after the run (measures)
    build(p, mj)             bodies, joints, tendons ... in MuJoCo (physical parts)

p, u, x, y and m have the declared parameters, inputs, states, outputs and metrics as
attributes. These are plain numbers in SI; angles are in radians.
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


End = float | str  # one end of a range: a number in the declared unit, or an expression of parameters in SI


@dataclass(frozen=True)
class Parameter:
    """A number that a spec can set and tune.

    Attributes:
        unit: The unit of default and bounds, and of values in a spec.
        doc: What it is.
        default: Its value if the spec sets none; without a default, a spec must set it.
        bounds: The range in which it makes sense.
        source: A key of the library's `references.bib`, or "definition: why".
        whole: Whether it is a whole number, such as a count or a seed. It can neither be tuned nor set by a signal.
    """

    unit: str
    doc: str
    default: float | None = None
    bounds: tuple[float, float] | None = None
    source: str = ""
    whole: bool = False


@dataclass(frozen=True)
class Points:
    """A list of points on segments, such as `[{on: shank, at: [-4 cm, 0 m, 30 %]}, ...]`. Every number can be tuned."""

    doc: str
    unit: str = "m"


@dataclass(frozen=True)
class Series:
    """A recorded curve: `size` numbers at equal distances from 0 to 100 % of a cycle. It cannot be tuned.

    A spec names a column of a table, such as `norms/fukuchi2018_walking.knee_flexion`, or writes a list, such as `[0
    deg, 60 deg, 0 deg]`. Both are interpolated to this size.

    Attributes:
        listed: Whether the numbers are a list of their own instead, such as instants and values at them: at most `size`
            numbers, as they are written, and nan after the last. Instants, in units of time, increase.
    """

    unit: str
    doc: str
    size: int
    listed: bool = False


@dataclass(frozen=True)
class Option:
    """One word from a list of choices. It acts when the model is built, and cannot be tuned."""

    doc: str
    choices: tuple[str, ...]
    default: str | None = None


@dataclass(frozen=True)
class Attachment:
    """A frame of another part, to which this part is fastened, such as `parent: thigh.distal`."""

    doc: str


@dataclass(frozen=True)
class Frame:
    """A place on this part to which others can be fastened. A part with frames is a body of its own."""

    doc: str


@dataclass(frozen=True)
class Input:
    """A signal that the part receives.

    Attributes:
        unit: The unit of the signal; `*` accepts every unit.
        sums: Whether any number of senders may be connected (`to:`), which are added; else there is one (`from:`).
        usual: The usual range at the start, as for an output.
        possible: The possible range at the start, as for an output.
        like: For the unit `*`, the series whose unit the signal must fit.
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
    """A signal that the part sends.

    Attributes:
        usual: The usual range at the start of a run. A start outside it is reported.
        possible: The possible range at the start of a run. A start outside it is an error.
        like: For the unit `*`, the series or the parameter in whose unit the signal is.

    Both ranges have a low and a high end: numbers in `unit`, or expressions of parameters in SI, such as "upper + 0.1".
    """

    unit: str
    doc: str
    usual: tuple[End, End] | None = None
    possible: tuple[End, End] | None = None
    like: str = ""


@dataclass(frozen=True)
class State:
    """What a part remembers from step to step: one number, `size` numbers, or one of the named `levels`.

    Attributes:
        usual: The usual range at the start, for a state of one number.
        possible: The possible range at the start, for a state of one number.
    """

    unit: str = "1"
    doc: str = ""
    size: int | None = None
    levels: tuple[str, ...] = ()
    usual: tuple[End, End] | None = None
    possible: tuple[End, End] | None = None


@dataclass(frozen=True)
class Metric:
    """A number that a measure computes after the run. The metric `value` has the name of the measure itself.

    Attributes:
        unit: The unit; `*` is that of the measured signal.
        like: For the unit `*`, a series whose unit is used instead if it measures the same quantity. Both are then in
            deg, although the angle of a joint is in rad.
    """

    unit: str
    doc: str
    like: str = ""


@dataclass(frozen=True)
class Part:
    """An inner part, such as the path of a muscle. A spec replaces it with `use:`.

    Attributes:
        reads: Pairs of an input of this part and the output of the inner part that it reads.
        sends: Pairs of an input of the inner part and the input or output of this part that it receives.
        gives: Pairs of a parameter of the inner part and an expression of parameters of this part, which sets it unless
            a spec does.
        optional: Whether the part exists only if a spec names one.
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
    """Connections with another part that a spec makes by one name, such as `joint: ankle`.

    Attributes:
        reads: Pairs of an input of this part and the output of the other part that it reads.
        sends: Pairs of an input of the other part and the output of this part that it receives.
    """

    doc: str
    reads: tuple[tuple[str, str], ...] = ()
    sends: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class StepLimit:
    """The largest time step at which the component is accurate, found by measurement.

    `gaitsim check`, `run` and `optimize` warn of a longer step.

    Attributes:
        doc: What was measured, and with which error.
    """

    unit: str
    doc: str
    value: float


@dataclass(frozen=True)
class Curve:
    """A graph of the component alone, drawn by `gaitsim library show --plot`.

    Attributes:
        of: An output, or a function of this file.
        over: An input, a state, an output that MuJoCo sets, an argument of the function, or "time".
        span: The range of `over`, in its unit.
        at: Values of all else that is read, by name and in their units; a word is the name of a parameter.
        each: A name and its values; each value is one line of the graph.
        steps: Inputs over time: the values that each takes one after the other, for equal times.
        unit: The unit of the result of a function.
        over_unit: The unit of its argument.
        inverse: Whether the axes are exchanged.
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
    """Raised by a `build` that cannot make a part from its numbers. The text is reported at the place of the part in
    the spec.
    """


class Component:
    """The base class of components. Declarations are read from the body of the subclass."""

    declarations: ClassVar[dict[str, Declaration]] = {}

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        own = {name: value for name, value in vars(cls).items() if isinstance(value, Declaration)}
        cls.declarations = {**cls.declarations, **own}
