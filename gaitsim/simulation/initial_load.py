"""Initial poses in which the ground carries a given share of the body weight."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import mujoco
import numpy as np

from gaitsim.compiler.kernel import STAGES, native_function
from gaitsim.compiler.mechanics.places import Lift
from gaitsim.compiler.mjcf import Assembly, tie_place
from gaitsim.compiler.program import Floats, Integers, Program
from gaitsim.components.load import function_of
from gaitsim.errors import Fault, InvalidSpec, SimulationFailed
from gaitsim.simulation.failure import of_exception
from gaitsim.simulation.view import views

_FIRST = 0.004  # m: the depth that is tried first; soles and heels yield by some millimetres
_DOUBLINGS = 6  # of that depth, to 0.256 m
_NEAR = 1e-8  # the error of the load that is allowed, as a share of it
_TRIALS = 60  # about six are needed; a force with a jump takes all


class Ground:
    """The ground under one program and one MuJoCo model, at the first instant.

    Only contacts and the parts on which they depend are computed.
    """

    def __init__(self, program: Program, assembly: Assembly, data: Any, native: bool) -> None:
        """Look up places and functions.

        Args:
            program: The program.
            assembly: Its mechanics.
            data: MuJoCo's data.
            native: Whether parts are computed in native code, which is faster and gives the same bits.
        """
        self.program, self.model, self.data = program, assembly.model, data
        contacts = [i for i in assembly.carried if "load" in program.model.parts[i].type.outputs]
        needed = _needed(program, contacts)
        self.calls = [call for call in program.calls if call.part in needed]
        self.loads = [program.outputs.place(i, "load") for i in contacts]
        layouts = (program.parameters, program.inputs, program.states, program.outputs)
        self.tables = tuple(np.zeros(layout.size) for layout in layouts)
        self.views = {i: views(program, i, *self.tables) for i in needed}
        self.kernels = {i: self._kernel(i) for i in needed} if native else {}
        self.reads = list(_reads(program, assembly, data, needed))

    def carry(self, lift: Lift, values: Sequence[float], states: Mapping[int, float]) -> None:
        """Move a vertical joint until the ground carries its load.

        Args:
            lift: The joint. At its present coordinate the lowest contact touches the ground.
            values: All numbers of the model, in SI.
            states: The initial values of states, by index.

        Raises:
            InvalidSpec: No height has this load.
            SimulationFailed: A component raised an exception.
        """
        program, place = self.program, int(self.model.joint(lift.joint).qposadr[0])
        p, u, x, y = self.tables
        numbers, touching = np.asarray(values, dtype=np.float64), float(self.data.qpos[place])
        p[:], u[:], x[:], y[:] = program.parameter_table(numbers), 0.0, 0.0, 0.0
        base = program.input_base(numbers)
        before = [math.nan if line.initial is None else values[line.initial] for line in program.delays]

        def excess(depth: float) -> float:
            self.data.qpos[place] = touching - depth
            return self._load(base, before, states) - lift.load

        with np.errstate(all="ignore"):
            rest = _zero(excess, _NEAR * lift.load)
        if not abs(rest) <= _NEAR * lift.load:
            part, depth = program.model.parts[lift.part], touching - float(self.data.qpos[place])
            shown = round(100 * depth, 1) + 0.0  # not -0
            rule = f"load is {lift.load:g}, which the ground carries at no height at the start"
            found = f"{shown:g} cm below the first touch it carries {lift.load + rest:.3g}"
            move = "change load, or the posture and the velocities in initial:"
            raise InvalidSpec(Fault(f"{rule}: {found}; {move}.", program.model.place(part), part.address))

    def _load(self, base: Floats, before: Sequence[float], states: Mapping[int, float]) -> float:
        """What the ground carries at the present coordinates, in body weights."""
        _, u, x, y = self.tables
        mujoco.mj_step1(self.model, self.data)
        for places, array, indices in self.reads:
            y[places] = array[indices]
        for call in self.calls:
            for slot in self.program.inputs.span(call.part):
                u[slot] = base[slot]
                for sender, line in self.program.senders[slot]:
                    u[slot] += y[sender] if line < 0 or math.isnan(before[line]) else before[line]
            if call.last:
                self._call(call.part, "start")
                for state, value in states.items():
                    x[state] = value
            self._call(call.part, "output")
        return float(sum(y[place] for place in self.loads))

    def _kernel(self, part: int) -> Callable[[int], int]:
        """The native function of a part on its numbers in the tables, for the index of a stage."""
        program, kernel = self.program, native_function(self.program.model.parts[part].type)
        layouts = (program.parameters, program.inputs, program.states, program.outputs)
        begins = zip(self.tables, layouts, strict=True)
        places = [table.ctypes.data + table.itemsize * int(layout.offsets[part]) for table, layout in begins]
        return lambda stage: kernel(stage, *places, 0.0)

    def _call(self, part: int, stage: str) -> None:
        kind, (p, u, x, y) = self.program.model.parts[part].type, self.views[part]
        if stage not in kind.functions:
            return
        # What raises in native code is called again in Python, which says why.
        if part not in self.kernels or self.kernels[part](STAGES[stage]):
            try:
                function_of(kind.cls, stage)(*((p, u, x) if stage == "start" else (p, u, x, y)))
            except Exception as error:
                raise SimulationFailed(of_exception(self.program, part, stage, 0, error)) from error


def _needed(program: Program, contacts: Iterable[int]) -> set[int]:
    """The contacts, and the parts from which their inputs come."""
    found: set[int] = set()
    ahead = list(contacts)
    while ahead:
        part = ahead.pop()
        if part not in found:
            found.add(part)
            senders = (sender for slot in program.inputs.span(part) for sender, _ in program.senders[slot])
            ahead += [program.part_of_output(sender) for sender in senders]
    return found


def _reads(
    program: Program, assembly: Assembly, data: Any, needed: set[int]
) -> Iterator[tuple[Integers, Floats, Integers]]:
    """For each array of MuJoCo's data that is read: the places in the table of outputs, the array, and its indices."""
    ties = [(part, tie) for part, tie in assembly.reads if part in needed]
    for name in dict.fromkeys(tie.field for _, tie in ties):
        chosen = [(part, tie) for part, tie in ties if tie.field == name]
        places = np.array([program.outputs.place(part, tie.port) for part, tie in chosen])
        indices = np.array([tie_place(assembly.model, tie) for _, tie in chosen])
        yield places, np.ravel(getattr(data, name)), indices


def _zero(function: Callable[[float], float], near: float) -> float:
    """Find a zero of a growing function: by doubling, then by the method of Anderson and Björck between two ends.

    Returns:
        The value at the last place that was tried. It is farther from 0 than `near` if there is no zero; the place is
            then that of the greatest value, or the one just behind a jump.
    """
    place, value = _FIRST, function(_FIRST)
    end, end_value = place, value
    for k in range(_DOUBLINGS):
        if not value * end_value > 0:
            break
        end, end_value = place, value
        place = 2 * place if value < 0 else -k * _FIRST
        value = function(place)
    for _ in range(_TRIALS):
        if abs(value) <= near or not value * end_value < 0:
            break
        last, last_value = place, value
        place -= value * (place - end) / (value - end_value)
        value = function(place)
        if value * last_value < 0:
            end, end_value = last, last_value
        else:
            # The other end stays. With its value made smaller, the next secant leads beyond the zero.
            share = 1 - value / last_value
            end_value *= share if share > 0 else 0.5
    return value if abs(value) <= near else function(max(place, end))
