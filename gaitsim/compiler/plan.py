"""What native code of a program is made from: plain numbers, none of which a candidate changes."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

from gaitsim.compiler.kernel import STAGES, Kernel, kernel_of
from gaitsim.compiler.mjcf import Assembly
from gaitsim.compiler.program import Program
from gaitsim.components.checks.check import GUARD
from gaitsim.components.primitive import Primitive
from gaitsim.model import Part


@dataclass(frozen=True)
class Piece:
    """One part in native code: its kernel, where its fields lie in the tables, and how many there are.

    Attributes:
        wary: Its code might never end on numbers that are not finite, so it must not see any.
    """

    kernel: str
    stages: tuple[str, ...]
    parameters: int
    inputs: range
    states: range
    outputs: range
    wary: bool


@dataclass(frozen=True)
class Step:
    """One call of a part's `output`;

    Attributes:
        last: Whether all inputs are known at this call.
        always: In every step, not at the start only.
    """

    piece: int
    last: bool
    always: bool


@dataclass(frozen=True)
class Plan:
    """The pieces, who is called in which order, and what reads what.

    Attributes:
        senders: For each input its senders as (output, delay line or -1).
        constant: Inputs that have a number of their own besides.
        lines: The output that each delay line keeps.
        signals: What is recorded, a place in the outputs or behind them in the states.
        reads: An output and whether it may change after the start, for each number read of MuJoCo. writes: (an output?
            its place, sign) for each number written there.
        coordinates: How many positions and velocities MuJoCo has.
        runge_kutta: Whether MuJoCo steps by rk4.
        guards: Parts with events, and the output that rises through 0 then.
        resets: What events set, as of `writes`, and the same of when they do.
    """

    pieces: tuple[Piece, ...]
    calls: tuple[Step, ...]
    updates: tuple[int, ...]
    senders: tuple[tuple[tuple[int, int], ...], ...]
    constant: tuple[bool, ...]
    lines: tuple[int, ...]
    stops: tuple[int, ...]
    signals: tuple[int, ...]
    reads: tuple[tuple[int, bool], ...]
    writes: tuple[tuple[bool, int, float], ...]
    coordinates: tuple[int, int]
    runge_kutta: bool
    states: int
    outputs: int
    guards: tuple[tuple[int, int], ...]
    resets: tuple[tuple[tuple[bool, int], tuple[bool, int]], ...]


def plan_of(program: Program, assembly: Assembly) -> tuple[Plan, dict[str, Kernel]]:
    """The plan of a program with its mechanics, and the kernels that it names."""
    parts = program.model.parts
    kernels = [kernel_of(part.type) for part in parts]
    reads = [(program.outputs.place(i, tie.port), tie.field != "userdata") for i, tie in assembly.reads]

    def sent(part: int, port: str) -> tuple[bool, int]:
        of_outputs = port in parts[part].type.outputs
        return of_outputs, (program.outputs if of_outputs else program.inputs).place(part, port)

    writes = [(*sent(i, tie.port), tie.sign) for i, tie in assembly.applies]
    fixed = _constant_parts(program, {i for i, tie in assembly.reads if tie.field != "userdata"})
    pieces = tuple(
        Piece(
            kernel.name,
            tuple(stage for stage in STAGES if stage in part.type.functions),
            int(program.parameters.offsets[i]),
            program.inputs.span(i),
            program.states.span(i),
            program.outputs.span(i),
            _has_open_loop(part.type),
        )
        for i, (part, kernel) in enumerate(zip(parts, kernels, strict=True))
    )
    plan = Plan(
        pieces,
        tuple(Step(call.part, call.last, call.part not in fixed) for call in program.calls),
        program.updates,
        program.senders,
        tuple(program.has_base),
        tuple(line.sender for line in program.delays),
        tuple(program.outputs.place(i, "stop") for i in program.stops),
        tuple(int(place) for place in program.signal_places),
        tuple(reads),
        tuple(writes),
        (int(assembly.model.nq), int(assembly.model.nv)),
        assembly.runge_kutta,
        program.states.size,
        program.outputs.size,
        tuple((i, program.outputs.place(i, GUARD)) for i in program.guarded),
        tuple((sent(i, tie.port), sent(i, tie.when)) for i, tie in assembly.resets),
    )
    return plan, {kernel.name: kernel for kernel in kernels}


def _constant_parts(program: Program, moved: set[int]) -> set[int]:
    """Parts whose outputs stay what they are at the start, so that they are not called again.

    Args:
        moved: Parts with outputs that MuJoCo changes.
    """
    found: set[int] = set()
    for call in program.calls:
        part = program.model.parts[call.part]
        if call.last and call.part not in moved and not {"update", "reset"} & part.type.functions:
            slots = [program.inputs.place(call.part, name) for name in _read(part)]
            senders = [sender for slot in slots for sender in program.senders[slot]]
            if all(line < 0 and program.part_of_output(sender) in found for sender, line in senders):
                found.add(call.part)
    return found


def _read(part: Part) -> Sequence[str]:
    """The inputs that a call of `output` depends on; all of them if it might raise."""
    kind = part.type
    if "output" not in kind.functions:
        return ()
    if kind.outputs and not _may_raise(kind):
        return [name for name in kind.inputs if any(name in needed for needed in kind.dependencies.values())]
    return list(kind.inputs)


# Read from the text, and rather seen once too often: words of a docstring count, and a missed one would not.
_RAISES = re.compile(r"\braise\b|\bassert\b|\[")
_OPEN_LOOP = re.compile(r"\bwhile\b|\bfor\b.*\bin\b(?! range\([\d, ]+\):)")


@cache
def _may_raise(kind: Primitive) -> bool:
    return _RAISES.search(kind.code) is not None


@cache
def _has_open_loop(kind: Primitive) -> bool:
    """Whether a loop goes on until something is reached, or for a number of times that is computed."""
    return _OPEN_LOOP.search(kind.code) is not None
