"""Runs a program in rapid mode: fills the native loop's tables for one candidate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from gaitsim.compiler.kernel import address_of
from gaitsim.compiler.mjcf import tie_place
from gaitsim.compiler.program import Floats, Integers, Layout, Program
from gaitsim.simulation import native_loop as native
from gaitsim.simulation.body import Body
from gaitsim.simulation.ending import Ending
from gaitsim.simulation.failure import of_component
from gaitsim.simulation.waiting import interruptible

_STAGES = {native.START: "start", native.OUTPUT: "output", native.UPDATE: "update"}


def _begins(layout: Layout) -> Integers:
    return np.append(layout.offsets, layout.size).astype(np.int64)


def _integers(rows: Any, width: int = 0) -> Integers:
    table = np.array(rows, dtype=np.int64)
    return table.reshape(-1, width) if width else table


@dataclass
class Rapid:
    """A program in native code."""

    program: Program
    body: Body = field(init=False)

    def __post_init__(self) -> None:
        self.body = Body(self.program)

    @cached_property
    def _fixed(self) -> dict[str, Any]:
        """The tables that are the same for every candidate."""
        program = self.program
        senders = program.senders
        flat = [sender for each in senders for sender in each]
        return {
            "kernels": _integers([address_of(part.type) for part in program.model.parts]),
            "p_at": _begins(program.parameters),
            "u_at": _begins(program.inputs),
            "x_at": _begins(program.states),
            "y_at": _begins(program.outputs),
            "calls": _integers([(c.part, c.last) for c in program.calls], 2),
            "updates": _integers(program.updates),
            "senders": _integers(np.cumsum([0, *(len(each) for each in senders)])),
            "source": _integers([source for source, _ in flat]),
            "line": _integers([line for _, line in flat]),
            "line_source": _integers([line.source for line in program.delays]),
            "stops": _integers([program.outputs.place(i, "stop") for i in program.stops]),
            "signals": program.signal_places,
        }

    def _tables(self, values: Sequence[float]) -> native.Tables:
        program, steps = self.program, self.program.delay_steps(values)
        whole, sizes = np.floor(steps), program.capacities(values)
        states = self.body.initial_states(values)
        initial = [np.nan if line.initial is None else values[line.initial] for line in program.delays]
        reads, writes, signs = self._ties()
        return native.Tables(
            **self._fixed,
            base=program.input_base(values),
            line_begin=_integers(np.cumsum([0, *sizes])[:-1]),
            line_size=sizes,
            line_whole=whole.astype(np.int64),
            line_rest=steps - whole,
            line_initial=np.array(initial, dtype=np.float64),
            reads=reads,
            appliers=_integers(self.body.appliers),
            writes=writes,
            signs=signs,
            initial_place=_integers(list(states)),
            initial_value=np.array(list(states.values()), dtype=np.float64),
        )

    def _ties(self) -> tuple[Integers, Integers, Floats]:
        """Addresses in MuJoCo's data of what is read and written."""
        program, body = self.program, self.body

        def address(tie: Any) -> int:
            view = body.array(tie.field)
            return int(view.ctypes.data + view.itemsize * tie_place(body.model, tie))

        reads = [(address(tie), program.outputs.place(i, tie.port)) for i, tie in body.assembly.reads]
        writes, signs = [], []
        for i, tie in body.assembly.applies:
            of_outputs = tie.port in program.model.parts[i].type.outputs
            table = program.outputs if of_outputs else program.inputs
            writes.append((address(tie), of_outputs, table.place(i, tie.port)))
            signs.append(tie.sign)
        return _integers(reads, 2), _integers(writes, 3), np.array(signs, dtype=np.float64)

    def prepare(self) -> None:
        """Compile or load all native code, and check what only the posed model can tell.

        Errors: InvalidComponent, InvalidSpec.
        """
        self.body.check_initial()
        self.run(self.program.model.values(), 0, recorded=False)

    def run(self, values: Sequence[float], steps: int, recorded: bool) -> Ending:
        """Simulate one candidate's numbers."""
        program, body = self.program, self.body
        body.pose(values)
        tables = self._tables(values)
        p = program.parameter_table(values)
        u, x, y = (np.zeros(layout.size) for layout in (program.inputs, program.states, program.outputs))
        buffer = np.zeros(int(np.sum(tables.line_size)))
        record = np.zeros((steps if recorded else 0, len(program.signals)))
        model, data = body.model, body.data  # held by the call below for as long as it computes

        def compute() -> tuple[int, int, int, int]:
            places = model._address, data._address, body.array("qpos"), body.array("qvel")
            dt = program.model.simulate.step
            found: tuple[int, int, int, int] = native.simulate(steps, dt, *places, tables, p, u, x, y, buffer, record)
            return found

        try:
            status, part, stage, done = interruptible(compute)
        except KeyboardInterrupt:
            self.body = Body(program)  # the old one is still computed in
            raise
        failure, stopped_by = None, None
        if status in (native.RAISED, native.NOT_FINITE):
            failure = of_component(program, part, _STAGES[stage], done, p, u, x, y)
        elif status == native.DIVERGED:
            failure = body.divergence(done)
        elif status == native.STOPPED:
            stopped_by = program.part_of_output(part)
        rows = record[: done + (stopped_by is not None)]
        return Ending(done, stopped_by, failure, p, x, rows if recorded else None)
