"""The contract of a component file: declarations and small pure functions.

A component file holds one subclass of `Component`. Its class body declares parameters,
ports, states and parts; its static functions say what happens:

    start(p, u, x)           states once the whole model is posed
    output(p, u, x, y)       outputs of this instant
    update(p, u, x, y, dt)   states of the next instant; all inputs are of this instant
    finish(p, x, m)          metrics after the run (measures)
    build(p, mj)             bodies, joints, tendons ... in MuJoCo (physical parts)

p, u, x, y and m carry the declared parameters, inputs, states, outputs and metrics as
attributes: plain numbers in SI. Angles are in radians.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

__all__ = [
    "Attachment",
    "Component",
    "Frame",
    "Input",
    "Metric",
    "Option",
    "Output",
    "Parameter",
    "Part",
    "Points",
    "State",
]


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
    """A signal that comes in. `sums`: any number of senders (`to:`); else one (`from:`)."""

    unit: str
    doc: str
    default: float | None = None
    sums: bool = False


@dataclass(frozen=True)
class Output:
    """A signal that goes out."""

    unit: str
    doc: str


@dataclass(frozen=True)
class State:
    """What is remembered between steps: a number, `size` numbers, or one of named `levels`."""

    unit: str = "1"
    doc: str = ""
    size: int | None = None
    levels: tuple[str, ...] = ()


@dataclass(frozen=True)
class Metric:
    """A number that a measure reports after the run. One named `value` bears the measure's own name."""

    unit: str
    doc: str


@dataclass(frozen=True)
class Part:
    """A part inside this one, such as a muscle's path; a spec swaps it with `use:`.

    reads: this part's input <- the inner part's output.
    sends: the inner part's input <- this part's input or output.
    """

    kind: str
    doc: str
    default: str | None = None
    reads: tuple[tuple[str, str], ...] = ()
    sends: tuple[tuple[str, str], ...] = ()


Declaration = Parameter | Points | Option | Attachment | Frame | Input | Output | State | Metric | Part


class Component:
    """The base of every component. What a subclass declares is read from its class body."""

    declarations: ClassVar[dict[str, Declaration]] = {}

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        own = {name: value for name, value in vars(cls).items() if isinstance(value, Declaration)}
        cls.declarations = {**cls.declarations, **own}
