"""C functions from generated Python, compiled once on a machine and kept in the cache."""

from __future__ import annotations

import hashlib
import linecache
import os
import pickle
import platform
import sys
from functools import cache
from types import ModuleType
from typing import Any

import llvmlite.binding
import numba
import numpy as np
from numba.core import sigutils
from numba.core.caching import NullCache
from numba.core.ccallback import CFunc
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from gaitsim import __version__
from gaitsim.cache import keep, kept, tell_once


def native(kind: str, text: str, file: str, name: str, signature: Any) -> CFunc:
    """The C function that a function of a text becomes; its `address` is what calls it.

    Args:
        kind: The folder of the cache: kernels, programs.
        text: A Python module. Its machine code must follow from it, gaitsim's version and the machine alone.
        file: How errors and tracebacks call the text.
        name: The function in it.
        signature: Its numba types.

    Errors: numba's own.
    """
    key = hashlib.sha256(f"{name}|{signature}|{text}|{_environment()}".encode()).hexdigest()[:32]
    module = _executed(f"gaitsim_{kind}_{key}", text, file)
    made = CFunc(getattr(module, name), sigutils.normalize_signature(signature), {}, {"error_model": "numpy"})
    made._cache = _Entry(kind, key)  # type: ignore[attr-defined]
    made.compile()
    return made


class _Entry(NullCache):  # type: ignore[misc]
    """What numba asks for the machine code of one C function, and gives it to."""

    def __init__(self, kind: str, key: str) -> None:
        self.kind, self.key = kind, key

    def load_overload(self, _: Any, target: Any) -> CompileResult | None:
        """The machine code as it was kept; None if there is none."""
        target.refresh()
        data = kept(self.kind, self.key)
        if data is None:
            return None
        try:
            return CompileResult._rebuild(target, *pickle.loads(data))
        except Exception as error:  # whatever it is, compiling anew mends it
            tell_once(f"machine code in the cache cannot be used ({type(error).__name__}); it is compiled again.")
            return None

    def save_overload(self, _: Any, result: CompileResult) -> None:
        """Keep new machine code, unless it holds addresses of this process."""
        if not result.library.has_dynamic_globals:
            keep(self.kind, self.key, dumps(result._reduce()))


def _executed(name: str, text: str, file: str) -> ModuleType:
    """A text as a module; numba finds it by its name, and errors find its lines."""
    module = ModuleType(name)
    module.__file__ = file
    linecache.cache[file] = (len(text), None, text.splitlines(keepends=True), file)
    sys.modules[name] = module
    exec(compile(text, file, "exec"), module.__dict__)
    return module


@cache
def _environment() -> str:
    """What else the machine code depends on."""
    processor = llvmlite.binding.get_host_cpu_name()
    features = llvmlite.binding.get_host_cpu_features().flatten()
    versions = [__version__, numba.__version__, np.__version__, platform.python_version()]
    switches = sorted(f"{k}={v}" for k, v in os.environ.items() if k.startswith("NUMBA_"))
    return "|".join([*versions, processor, features, *switches])
