"""One kernel for each type of component, as LLVM bitcode, cached by the digest of everything that it is made from.

The texts of the component and of its shared files are compiled unchanged, so that line numbers are correct. A footer
makes one function of the component's functions. numba is imported only when a kernel is compiled.
"""

from __future__ import annotations

import ctypes
import hashlib
import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from types import FunctionType, ModuleType
from typing import Any

from gaitsim.cache import cached, keep
from gaitsim.compiler import machine
from gaitsim.components.checks.shared import builtins_with
from gaitsim.components.primitive import Primitive
from gaitsim.errors import Fault, InvalidComponent, Mark

START, OUTPUT, UPDATE, RESET = 0, 1, 2, 3
STAGES = {"start": START, "output": OUTPUT, "update": UPDATE, "reset": RESET}

_C_FUNCTION = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, *[ctypes.c_void_p] * 4, ctypes.c_double)
_OPTIONS = {"error_model": "numpy", "boundscheck": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
_FOOTER = """

# Appended by gaitsim: the functions above as one.
import numpy as _np
from numba import from_dtype as _from_dtype, njit as _njit, types as _types

_OPTIONS = {options!r}
_RECORDS = [_from_dtype(_np.dtype(_each)) for _each in ({parameters!r}, {inputs!r}, {states!r}, {outputs!r})]
{functions}


@_njit(_types.int64(_types.int64, *_RECORDS, _types.float64), **_OPTIONS)
def kernel(stage, parameters, inputs, states, outputs, dt):
{calls}
    return 0
"""
_ARGUMENTS = {
    "start": "parameters, inputs, states",
    "output": "parameters, inputs, states, outputs",
    "update": "parameters, inputs, states, outputs, dt",
    "reset": "parameters, inputs, states, outputs, dt",  # here the last argument is the time
}
# numba's calling convention: pointers for result and exception; the return value is 0 unless it raised.
_ALONE = """
declare i32 @{name}(ptr, ptr, i64, ptr, ptr, ptr, ptr, double)

define i64 @{name}.alone(i64 %stage, ptr %p, ptr %u, ptr %x, ptr %y, double %dt) {{
  %result = alloca i64
  %raised = alloca ptr
  store ptr null, ptr %raised
  %status = call i32 @{name}(ptr %result, ptr %raised, i64 %stage, ptr %p, ptr %u, ptr %x, ptr %y, double %dt)
  %wide = zext i32 %status to i64
  ret i64 %wide
}}
"""


@dataclass(frozen=True)
class Kernel:
    """The native functions of one type of component.

    Attributes:
        name: The name in LLVM IR, which no other kernel has.
    """

    component: Primitive
    name: str

    def bitcode(self) -> bytes:
        """Compile the kernel, or read it from the cache.

        Returns:
            A module with `int32 name(result*, exception**, stage, p*, u*, x*, y*, dt)`, which returns 0 unless it
                raises.

        Raises:
            InvalidComponent: The component cannot become native code.
        """
        found = cached("kernels", self.name)
        if found is None:
            found = _compiled(self)
            keep("kernels", self.name, found)
        return found


@cache
def kernel_of(component: Primitive) -> Kernel:
    """The kernel of a component. It is compiled when its bitcode is first needed."""
    text = component.code + _footer(component)
    digest = hashlib.sha256(f"{text}|{machine.environment()}".encode()).hexdigest()
    return Kernel(component, f"kernel.{digest[:32]}")


def address_of(component: Primitive) -> int:
    """Load a component's native function alone.

    Returns:
        The address of `int64 (stage, p*, u*, x*, y*, dt)`, which returns 0 unless it raises.

    Raises:
        InvalidComponent: The component cannot become native code.
    """
    return _alone(component).address(f"{kernel_of(component).name}.alone")


def native_function(component: Primitive) -> Callable[..., int]:
    """A component's native function alone, as one of Python; see `address_of`."""
    return _C_FUNCTION(address_of(component))


@cache
def _alone(component: Primitive) -> machine.Code:
    kernel = kernel_of(component)

    def make() -> bytes:
        module = machine.linked(_ALONE.format(name=kernel.name), [kernel.bitcode()])
        return machine.object_file(module, [f"{kernel.name}.alone"])

    return machine.code("kernels", f"{kernel.name}.alone", make)


def _compiled(kernel: Kernel) -> bytes:
    import llvmlite.binding as llvm
    from numba.core.errors import NumbaError

    try:
        function = _executed(kernel).kernel
    except NumbaError as error:
        raise InvalidComponent(_explained(error, kernel.component)) from error
    (found,) = function.overloads.values()
    module = llvm.parse_assembly(found.library.get_llvm_str())
    module.get_function(found.fndesc.llvm_func_name).name = kernel.name
    return bytes(machine.stripped(module, [kernel.name]).as_bitcode())


def _executed(kernel: Kernel) -> ModuleType:
    """Execute the text of a component and its footer as a module; numba compiles what the footer tells it to."""
    component = kernel.component
    module = ModuleType(kernel.name.replace(".", "_"))
    sys.modules[module.__name__] = module
    try:
        spaces: dict[str, dict[str, Any]] = {file.name: {"__name__": module.__name__} for file in component.shared}
        for file in component.shared:
            exec(compile(file.text, file.display_path, "exec"), spaces[file.name])
        module.__dict__["__builtins__"] = builtins_with(spaces)
        exec(compile(component.text, component.display_path, "exec"), module.__dict__)
        _make_native([*spaces.values(), module.__dict__])
        exec(compile(_footer(component), kernel.name, "exec"), module.__dict__)
    finally:
        del sys.modules[module.__name__]
    return module


def _footer(component: Primitive) -> str:
    used = [name for name in _ARGUMENTS if name in component.functions]
    cls = component.cls.__name__
    functions = [f'_{n} = _njit({cls}.__dict__["{n}"].__func__, **_OPTIONS)' for n in used]
    calls = [f"    if stage == {STAGES[name]}:\n        _{name}({_ARGUMENTS[name]})" for name in used]
    return _FOOTER.format(
        parameters=_layout(dict.fromkeys(component.parameters) | {n: s.size for n, s in component.series.items()}),
        inputs=_layout(dict.fromkeys(component.inputs)),
        states=_layout({name: state.size for name, state in component.states.items()}),
        outputs=_layout(dict.fromkeys(component.outputs)),
        options=_OPTIONS,
        functions="\n".join(functions),
        calls="\n".join(calls),
    )


def _make_native(spaces: Iterable[dict[str, Any]]) -> None:
    """Replace all functions of some namespaces by native ones. Their constants are computed before."""
    from numba import njit

    made: dict[FunctionType, Any] = {}
    for space in spaces:
        for name, value in list(space.items()):
            if isinstance(value, FunctionType):
                made[value] = made.get(value) or njit(value, **_OPTIONS)
                space[name] = made[value]


def _layout(fields: dict[str, int | None]) -> list[tuple[str, str] | tuple[str, str, tuple[int]]]:
    """A record of doubles, some of them arrays. It has at least one field, as numba requires."""
    made: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for name, size in fields.items():
        made.append((name, "f8") if size is None else (name, "f8", (size,)))
    return made or [("_nothing", "f8")]


def _explained(error: Exception, component: Primitive) -> Fault:
    """The first sentence of numba's message, and the line that it is about."""
    text = re.sub(r"\x1b\[[0-9;]*m", "", str(error))
    places = [(file, int(n)) for file, n in re.findall(r'File "(.*?)", line (\d+)', text)]
    texts = {component.display_path: component.text} | {file.display_path: file.text for file in component.shared}
    own = (place for place in places if place[1] <= len(texts.get(place[0], "").splitlines()))
    file, line = next(own, (component.display_path, 0))
    lines = texts[file].splitlines()
    reasons = [row.strip() for row in text.splitlines() if row.strip()]
    reason = next((r for r in reasons if not r.startswith(("Failed in", "File", "During", "-", ">"))), "")
    shown = lines[line - 1] if line else ""
    column = len(shown) - len(shown.lstrip()) + 1 if line else 0
    why = f"numba says: {reason.rstrip('.:')}"
    message = f"this cannot become native code; write it with numbers, if, for and math only ({why})."
    return Fault(message, Mark(file, line, column, shown))
