"""A plan: what native code of a program is made from. It has plain numbers only, and none depends on the candidate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from gaitsim.compiler.kernel import STAGES, Kernel, kernel_of
from gaitsim.compiler.mjcf import Assembly
from gaitsim.compiler.program import Program
from gaitsim.components.checks.check import GUARD
from gaitsim.model import Part


@dataclass(frozen=True)
class Piece:
    """One part in native code: its kernel, the places of its fields in the tables, and their number.

    Attributes:
        wary: Whether its code may run forever on numbers that are not finite, so that it must not get any.
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
    """One call of a part's `output`.

    Attributes:
        last: Whether all inputs are known at this call.
        always: Whether it is called in every step, and not only at the start.
    """

    piece: int
    last: bool
    always: bool


@dataclass(frozen=True)
class Plan:
    """The parts, the order of calls, and the connections.

    Attributes:
        senders: For each input its senders as (output, delay line or -1).
        constant: The inputs that have a number of their own besides.
        lines: The output that each delay line keeps.
        signals: The recorded signals: indices of outputs, followed by states.
        reads: For each number read from MuJoCo, the output and whether it can change after the start.
        writes: For each number written to MuJoCo: whether it is an output, its index, and its sign.
        coordinates: The number of MuJoCo's positions and velocities.
        runge_kutta: Whether MuJoCo uses the integrator rk4.
        energy: Whether MuJoCo computes energies.
        integrate: MuJoCo's integrator, of models that need few of its stages, each of which is called alone; else "".
        own_stages: Whether gaitsim makes stages of MuJoCo's step itself; see `compiler/stages.py`.
        guards: The parts with events, and the output that rises through 0.
        resets: The numbers that events set, as in `writes`, and the port that says when.
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
    energy: bool
    integrate: str
    own_stages: bool
    states: int
    outputs: int
    guards: tuple[tuple[int, int], ...]
    resets: tuple[tuple[tuple[bool, int], tuple[bool, int]], ...]


def plan_of(program: Program, assembly: Assembly) -> tuple[Plan, dict[str, Kernel]]:
    """Make the plan of a program.

    Args:
        program: The program.
        assembly: Its mechanics.

    Returns:
        The plan, and the kernels by the name that it uses.
    """
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
            part.type.findings.open_loop,
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
        assembly.energy,
        assembly.integrate,
        assembly.own_stages,
        program.states.size,
        program.outputs.size,
        tuple((i, program.outputs.place(i, GUARD)) for i in program.guarded),
        tuple((sent(i, tie.port), sent(i, tie.when)) for i, tie in assembly.resets),
    )
    return plan, {kernel.name: kernel for kernel in kernels}


def _constant_parts(program: Program, moved: set[int]) -> set[int]:
    """The parts whose outputs do not change after the start, so that they are not called again.

    Args:
        moved: The parts with outputs that MuJoCo changes.
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
    """The inputs on which a call of `output` depends; all of them if it may raise."""
    kind = part.type
    if "output" not in kind.functions:
        return ()
    if kind.outputs and not kind.findings.may_raise:
        return [name for name in kind.inputs if any(name in needed for needed in kind.dependencies.values())]
    return list(kind.inputs)
