"""Makes the native code of a plan, and its kernels on all cores, or reads them from the cache.

Helpers are separate processes, because numba compiles one function at a time and a user's script need not be
importable, as `multiprocessing` requires. They share nothing but the cache. Each begins at another place of the same
list and skips what is in the cache by then.
"""

from __future__ import annotations

import contextlib
import gc
import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from gaitsim.cache import cached
from gaitsim.compiler import machine, stage_code
from gaitsim.compiler.kernel import Kernel, kernel_of
from gaitsim.compiler.native import CLOCK, TICKS
from gaitsim.compiler.plan import Plan
from gaitsim.components.checks.shared import Shared
from gaitsim.components.primitive import Primitive

# With fewer kernels, a helper would still be importing numba when everything is compiled.
_WORTH_A_HELPER = 4


def compiled(plan: Plan, kernels: Mapping[str, Kernel], timed: bool = False) -> machine.Code:
    """Make the machine code of a plan.

    Args:
        plan: The plan.
        kernels: The kernels by name.
        timed: Whether to add a stopwatch for each part.

    Returns:
        Machine code with the functions `start` and `run`.

    Raises:
        InvalidComponent: A kernel cannot become native code.
    """
    kind = "timed|" if timed else ""
    key = hashlib.sha256(f"{kind}{plan}|{machine.environment()}".encode()).hexdigest()[:32]

    def make() -> bytes:
        from gaitsim.compiler.stopwatch import TimedTranslation
        from gaitsim.compiler.translation import Translation

        bitcode = bitcode_of([*kernels.values()])
        if plan.own_stages:
            bitcode.append(stage_code.bitcode())
        translation = TimedTranslation(plan) if timed else Translation(plan)
        module = machine.linked(str(translation.module()), bitcode)
        for name in kernels:
            module.get_function(name).add_function_attribute("alwaysinline")
        return machine.object_file(module, ["start", "run", *([TICKS, CLOCK] if timed else [])])

    return machine.code("programs", key, make)


def bitcode_of(kernels: Sequence[Kernel]) -> list[bytes]:
    """The bitcode of each kernel; what is missing in the cache is compiled.

    Raises:
        InvalidComponent: A kernel cannot become native code.
    """
    missing = [kernel for kernel in kernels if cached("kernels", kernel.name) is None]
    helpers = _helpers(missing)
    try:
        return [kernel.bitcode() for kernel in kernels]
    finally:
        for helper in helpers:  # whatever a helper still compiles has been compiled here
            helper.terminate()
        for helper in helpers:
            helper.wait()


def _helpers(missing: Sequence[Kernel]) -> list[subprocess.Popen[bytes]]:
    """Start a process for each further core that has enough to do; none if no process can be started."""
    count = min(_cores(), len(missing) // _WORTH_A_HELPER + 1)
    started: list[subprocess.Popen[bytes]] = []
    with contextlib.suppress(OSError):
        for begin in _places(len(missing), count):
            started.append(_helper([*missing[begin:], *missing[:begin]]))
    return started


def _places(length: int, count: int) -> list[int]:
    """The index in the list at which each helper begins. This process begins at index 0."""
    return [length * number // count for number in range(1, count)]


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _helper(kernels: Sequence[Kernel]) -> subprocess.Popen[bytes]:
    """Start a process that compiles kernels.

    Raises:
        OSError: The process cannot be started.
    """
    components = [kernel.component for kernel in kernels]
    files = [(_texts(found), [_texts(file) for file in found.shared]) for found in components]
    command = [sys.executable, "-m", "gaitsim.compiler.compilation"]
    quiet = subprocess.DEVNULL  # faults are reported by the process that needs the kernel
    bare = os.environ | {"MUJOCO_GL": "off"}
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=quiet, stderr=quiet, env=bare)
    assert process.stdin is not None
    with contextlib.suppress(BrokenPipeError), process.stdin:
        process.stdin.write(json.dumps(files).encode())
    return process


def _texts(file: Primitive | Shared) -> tuple[str, str, str, str]:
    """A file as text: reference or name, path, name in messages, and content."""
    name = file.reference if isinstance(file, Primitive) else file.name
    return name, str(file.path), file.display_path, file.text


def _compile(files: Sequence[tuple[Sequence[str], Sequence[Sequence[str]]]]) -> None:
    """Compile each component that is not in the cache yet."""
    from gaitsim.components.load import load_primitive

    for (reference, path, display_path, text), others in files:
        shared = [Shared(name, Path(place), seen, text) for name, place, seen, text in others]
        kernel_of(load_primitive(reference, Path(path), display_path, text, shared)).bitcode()


if __name__ == "__main__":
    gc.disable()  # nearly all that numba makes stays to the end
    _compile(json.load(sys.stdin))
