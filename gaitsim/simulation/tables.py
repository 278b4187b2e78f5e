"""The tables of one run: all numbers of a candidate, laid out as its program says; the same in both modes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gaitsim.compiler.native import padded
from gaitsim.compiler.program import Floats, Integers, Program


@dataclass(frozen=True)
class Tables:
    """Parameters, inputs, states and outputs; constants of the inputs; the past of delayed signals.

    Attributes:
        past: A row for each of the last steps, a power of two of them, with a number for each delay line. whole, rest:
            each line's delay in steps.
        before: What it gives before the start; nan for what is sent at the start.
        places, values: Initial values of states.
        written: What was last written into MuJoCo, for rk4; nan before.
    """

    p: Floats
    u: Floats
    x: Floats
    y: Floats
    base: Floats
    past: Floats
    whole: Integers
    rest: Floats
    before: Floats
    places: Integers
    values: Floats
    written: Floats

    @staticmethod
    def of(program: Program, values: Sequence[float], initial: dict[int, float], writes: int) -> Tables:
        """The tables of a candidate before its start; `initial`: place of a state -> value; `writes`: into MuJoCo.

        Raises:
            SimulationFailed: A delay that an expression makes shorter than a step.
        """
        numbers = np.asarray(values, dtype=np.float64)
        delays = program.delay_steps(numbers)
        whole = np.floor(delays)
        before = [np.nan if line.initial is None else values[line.initial] for line in program.delays]
        # A line keeps its delay, two more to interpolate, and one to write.
        rows = 1 << int(np.max(np.ceil(delays), initial=0) + 2).bit_length()
        return Tables(
            program.parameter_table(numbers),
            np.zeros(program.inputs.size),
            np.zeros(padded(program.states.size)),
            np.zeros(padded(program.outputs.size)),
            program.input_base(numbers),
            np.zeros((rows, len(delays))),
            whole.astype(np.int64),
            delays - whole,
            np.array(before, dtype=np.float64),
            np.array(list(initial), dtype=np.int64),
            np.array(list(initial.values()), dtype=np.float64),
            np.full(writes, np.nan),
        )
