"""The tables of one run: all numbers of a candidate in the layout of its program, the same in both modes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gaitsim.compiler.native import padded
from gaitsim.compiler.program import Floats, Integers, Program


@dataclass(frozen=True)
class Tables:
    """Parameters, inputs, states and outputs, constants of the inputs, and delay lines.

    Attributes:
        past: A row for each of the last steps and a column for each delay line; the number of rows is a power of two.
        whole, rest: The delay of each line in steps, as an integer and a fraction.
        before: The value of each line before the start; nan for the signal at the start.
        places, values: Initial values of states.
        written: The numbers last written to MuJoCo, for rk4; nan before the first step.
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
        """Make the tables of a candidate.

        Args:
            program: The program.
            values: All numbers of the model, in SI.
            initial: Initial values of states by index.
            writes: The count of numbers that are written to MuJoCo.

        Raises:
            SimulationFailed: An expression makes a delay shorter than a step.
        """
        numbers = np.asarray(values, dtype=np.float64)
        delays = program.delay_steps(numbers)
        whole = np.floor(delays)
        before = [np.nan if line.initial is None else values[line.initial] for line in program.delays]
        # A line has its delay, two more rows to interpolate, and one to write.
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
