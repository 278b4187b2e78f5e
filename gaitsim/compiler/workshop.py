"""Makes the native code of a plan, and its kernels on all cores, or takes them from the cache.

Helpers are processes of their own: numba compiles one thing at a time, and a script of a user's need not be
importable, as it would have to be for `multiprocessing`. The cache is all that they share: each begins at
another place of the same list, and goes round past what is there by then.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from gaitsim.cache import kept
from gaitsim.compiler import machine
from gaitsim.compiler.kernel import Kernel, kernel_of
from gaitsim.compiler.native import CLOCK, TICKS
from gaitsim.compiler.plan import Plan
from gaitsim.components.checks.shared import Shared
from gaitsim.components.primitive import Primitive

# Below so many, a helper would be done importing numba after all is compiled.
_WORTH_A_HELPER = 4


def compiled(plan: Plan, kernels: Mapping[str, Kernel], timed: bool = False) -> machine.Code:
    """The machine code of a plan, with functions `start` and `run`;

    Args:
        timed: With a stopwatch for each part.

    Raises:
        InvalidComponent: A kernel cannot become native code.
    """
    kind = "timed|" if timed else ""
    key = hashlib.sha256(f"{kind}{plan}|{machine.environment()}".encode()).hexdigest()[:32]

    def make() -> bytes:
        from gaitsim.compiler.stopwatch import TimedTranslation
        from gaitsim.compiler.translation import Translation

        bitcode = bitcode_of([*kernels.values()])
        translation = TimedTranslation(plan) if timed else Translation(plan)
        module = machine.linked(str(translation.module()), bitcode)
        for name in kernels:
            module.get_function(name).add_function_attribute("alwaysinline")
        return machine.object_file(module, ["start", "run", *([TICKS, CLOCK] if timed else [])])

    return machine.code("programs", key, make)


def bitcode_of(kernels: Sequence[Kernel]) -> list[bytes]:
    """The code of each kernel, compiled where it is missing.

    Raises:
        InvalidComponent: A kernel cannot become native code.
    """
    missing = [kernel for kernel in kernels if kept("kernels", kernel.name) is None]
    helpers = _helpers(missing)
    try:
        return [kernel.bitcode() for kernel in kernels]
    finally:
        for helper in helpers:  # what one still compiles is compiled here by now
            helper.terminate()
        for helper in helpers:
            helper.wait()


def _helpers(missing: Sequence[Kernel]) -> list[subprocess.Popen[bytes]]:
    """A process for each further core that has enough to do; none where no process can be started."""
    count = min(_cores(), len(missing) // _WORTH_A_HELPER + 1)
    started: list[subprocess.Popen[bytes]] = []
    with contextlib.suppress(OSError):
        for begin in _places(len(missing), count):
            started.append(_helper([*missing[begin:], *missing[:begin]]))
    return started


def _places(length: int, count: int) -> list[int]:
    """Where in a list each helper begins; this process begins at its front."""
    return [length * number // count for number in range(1, count)]


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _helper(kernels: Sequence[Kernel]) -> subprocess.Popen[bytes]:
    """A process that compiles kernels.

    Raises:
        OSError: The file cannot be read or written.
    """
    components = [kernel.component for kernel in kernels]
    files = [(_texts(found), [_texts(file) for file in found.shared]) for found in components]
    command = [sys.executable, "-m", "gaitsim.compiler.workshop"]
    quiet = subprocess.DEVNULL  # a mistake is told by the process that needs the kernel
    bare = os.environ | {"MUJOCO_GL": "off"}
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=quiet, stderr=quiet, env=bare)
    assert process.stdin is not None
    with contextlib.suppress(BrokenPipeError), process.stdin:
        process.stdin.write(json.dumps(files).encode())
    return process


def _texts(file: Primitive | Shared) -> tuple[str, str, str, str]:
    """A file as text: its reference or name, its path, how errors name it, its content."""
    name = file.reference if isinstance(file, Primitive) else file.name
    return name, str(file.path), file.shown, file.text


def _compile(files: Sequence[tuple[Sequence[str], Sequence[Sequence[str]]]]) -> None:
    """Compile each component that no other process has compiled by then."""
    from gaitsim.components.load import load_primitive

    for (reference, path, shown, text), others in files:
        shared = [Shared(name, Path(place), seen, text) for name, place, seen, text in others]
        kernel_of(load_primitive(reference, Path(path), shown, text, shared)).bitcode()


if __name__ == "__main__":
    _compile(json.load(sys.stdin))
