"""Native code of a plan: what its functions are given and return, and how it comes from the cache."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping

from gaitsim.compiler import machine
from gaitsim.compiler.kernel import Kernel
from gaitsim.compiler.plan import Plan

# What `run` returns: all steps are done, something is not finite or raised, the mechanics diverged,
# or a part has stopped the run (STOPPED + which of the plan's stops).
COMPLETED, SUSPECT, DIVERGED, STOPPED = 0, 1, 2, 3
# Tables of states and outputs have a multiple of this many numbers, so that they are checked by the dozen.
PADDING = 32

# What functions are given, each an integer, a number (a double), a pointer to a table of its own, or a pointer
# into what others reach as well. First what all of a step get: its number and length, the tables, and the past
# of delayed signals: rows of one number for each line, a power of two of them, and each line's delay in steps.
_TABLES = {
    "dt": "number",
    "parameters": "pointer",
    "base": "pointer",
    "states": "pointer",
    "outputs": "pointer",
    "past": "pointer",
    "mask": "integer",
    "whole": "pointer",
    "rest": "pointer",
}
FRAME = {"step": "integer", **_TABLES}
# Addresses of what is read and written in MuJoCo's data; values before the start; initial values of states.
START = {
    **_TABLES,
    "ties": "pointer",
    "before": "pointer",
    "places": "pointer",
    "values": "pointer",
    "count": "integer",
    "rounds": "integer",
}
RUN = {
    **_TABLES,
    "ties": "pointer",
    "written": "pointer",
    "first": "integer",
    "steps": "integer",
    "model": "shared",
    "data": "shared",
    "qpos": "shared",
    "qvel": "shared",
    "record": "pointer",
    "reached": "pointer",
}


# Of code with a stopwatch: its table of ticks, for each part and then for these (the halves are those of MuJoCo's
# step), and the function that tells the tick.
TICKS, CLOCK = "ticks", "clock"
TIMED = ("first half", "second half", "reading", "steps")


def compiled(plan: Plan, kernels: Mapping[str, Kernel], timed: bool = False) -> machine.Code:
    """The machine code of a plan, with functions `start` and `run`; timed: with a stopwatch for each part.

    Errors: InvalidComponent if a kernel cannot become native code.
    """
    kind = "timed|" if timed else ""
    key = hashlib.sha256(f"{kind}{plan}|{machine.environment()}".encode()).hexdigest()[:32]

    def make() -> bytes:
        from gaitsim.compiler.stopwatch import TimedTranslation
        from gaitsim.compiler.translation import Translation
        from gaitsim.compiler.workshop import bitcode_of

        bitcode = bitcode_of([*kernels.values()])
        translation = TimedTranslation(plan) if timed else Translation(plan)
        module = machine.linked(str(translation.module()), bitcode)
        for name in kernels:
            module.get_function(name).add_function_attribute("alwaysinline")
        return machine.object_file(module, ["start", "run", *([TICKS, CLOCK] if timed else [])])

    return machine.code("programs", key, make)


def padded(size: int) -> int:
    """The size of a table that is checked as a whole."""
    return -(-size // PADDING) * PADDING
