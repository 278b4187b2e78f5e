"""`compiler/stages.py` as LLVM bitcode: functions that are given an address for each of their arguments."""

from __future__ import annotations

import hashlib
import inspect
from typing import Any

from gaitsim.cache import cached, keep
from gaitsim.compiler import machine, stages
from gaitsim.compiler.chains import TABLES, arguments

STAGES = ("look_at_paths", "look_at_contacts", "load_joints", "load_contacts", "advance")
# Every argument once. The native program is given their addresses in this order.
ADDRESSES = tuple(dict.fromkeys(argument for stage in STAGES for argument in arguments(stage)))

_OPTIONS = {"error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
_ENTRY = """
@njit(types.int64({kinds}), **options)
def entry({names}):
    {name}({arrays})
    return 0
"""
_LONG = "(1 << 40,)"  # the length of an array is not checked


def native_name(stage: str) -> str:
    """The name of a stage in LLVM IR: `int32 name(result*, exception**, argument* ...)`."""
    return f"stages.{stage}"


def bitcode() -> bytes:
    """Compile the stages, or read them from the cache."""
    text = inspect.getsource(stages)
    key = hashlib.sha256(f"{text}|{STAGES}|{machine.environment()}".encode()).hexdigest()
    name = f"stages.{key[:32]}"
    found = cached("kernels", name)
    if found is None:
        found = _compiled(text)
        keep("kernels", name, found)
    return found


def _compiled(text: str) -> bytes:
    import llvmlite.binding as llvm

    modules = [llvm.parse_assembly(_assembly(stage, text)) for stage in STAGES]
    for module in modules[1:]:
        modules[0].link_in(module)
    return bytes(machine.stripped(modules[0], [native_name(stage) for stage in STAGES]).as_bitcode())


def _assembly(stage: str, text: str) -> str:
    """One stage in LLVM IR, with everything that it calls."""
    import llvmlite.binding as llvm
    from numba import carray, njit, types

    space: dict[str, Any] = {"carray": carray, "njit": njit, "types": types, "options": _OPTIONS, "__name__": "stages"}
    exec(compile(text, stages.__file__, "exec"), space)
    for name, value in list(space.items()):
        if inspect.isfunction(value) and value.__module__ == "stages":
            space[name] = njit(value, **_OPTIONS)
    names = arguments(stage)
    kinds = [f"types.CPointer(types.{'int64' if name in TABLES else 'float64'})" for name in names]
    arrays = ", ".join(f"carray({name}, {_LONG})" for name in names)
    entry = _ENTRY.format(kinds=", ".join(kinds), names=", ".join(names), name=stage, arrays=arrays)
    exec(compile(entry, native_name(stage), "exec"), space)
    (found,) = space["entry"].overloads.values()
    module = llvm.parse_assembly(found.library.get_llvm_str())
    module.get_function(found.fndesc.llvm_func_name).name = native_name(stage)
    return str(machine.stripped(module, [native_name(stage)]))
