"""Compiles the kernels of a model on all cores.

Helpers are processes of their own: numba compiles one thing at a time, and a script of a user's need not be
importable, as it would have to be for `multiprocessing`. The cache is all that they share: each begins at
another place of the same list, and goes round past what is there by then.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from gaitsim.cache import kept
from gaitsim.compiler.kernel import Kernel, kernel_of

# Below so many, a helper would be done importing numba after all is compiled.
_WORTH_A_HELPER = 4


def bitcode_of(kernels: Sequence[Kernel]) -> list[bytes]:
    """The code of each kernel, compiled where it is missing.

    Errors: InvalidComponent if a kernel cannot become native code.
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
    """A process for each further core that has enough to do."""
    count = min(_cores(), len(missing) // _WORTH_A_HELPER + 1)
    return [_helper([*missing[begin:], *missing[:begin]]) for begin in _places(len(missing), count)]


def _places(length: int, count: int) -> list[int]:
    """Where in a list each helper begins; this process begins at its front."""
    return [length * number // count for number in range(1, count)]


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _helper(kernels: Sequence[Kernel]) -> subprocess.Popen[bytes]:
    components = [kernel.component for kernel in kernels]
    files = [[found.reference, str(found.path), found.shown, found.source] for found in components]
    command = [sys.executable, "-m", "gaitsim.compiler.workshop"]
    quiet = subprocess.DEVNULL  # a mistake is told by the process that needs the kernel
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=quiet, stderr=quiet)
    assert process.stdin is not None
    process.stdin.write(json.dumps(files).encode())
    process.stdin.close()
    return process


def _compile(files: Sequence[Sequence[str]]) -> None:
    """Compile each component that no other process has compiled by then."""
    from gaitsim.parts.load import load_primitive

    for reference, path, shown, source in files:
        kernel_of(load_primitive(reference, Path(path), shown, source)).bitcode()


if __name__ == "__main__":
    _compile(json.load(sys.stdin))
