"""One native kernel per component type, cached by the digest of everything it is made from.

The component's file is taken as it is, so that line numbers hold, and a footer is appended that
turns its functions into one C function.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any

from numba import types
from numba.core.errors import NumbaError

from gaitsim.compiler.native import native
from gaitsim.errors import Fault, InvalidComponent, Mark
from gaitsim.parts.primitive import Primitive

START, OUTPUT, UPDATE = 0, 1, 2

_FOOTER = '''

# Appended by gaitsim: the functions above as one C function.
import numpy as _np
from numba import carray as _carray, njit as _njit

_OPTIONS = {{"error_model": "numpy", "boundscheck": True}}
_P = _np.dtype({parameters!r})
_U = _np.dtype({inputs!r})
_X = _np.dtype({states!r})
_Y = _np.dtype({outputs!r})
{helpers}
{functions}


def kernel(stage, p, u, x, y, dt):
    parameters = _carray(p, 1, _P)[0]
    inputs = _carray(u, 1, _U)[0]
    states = _carray(x, 1, _X)[0]
    outputs = _carray(y, 1, _Y)[0]
    try:
{calls}
    except Exception:
        return 1
    return 0
'''
_SIGNATURE = types.int64(types.int64, *[types.voidptr] * 4, types.float64)
_ARGUMENTS = {
    "start": "parameters, inputs, states",
    "output": "parameters, inputs, states, outputs",
    "update": "parameters, inputs, states, outputs, dt",
}


def address_of(component: Primitive) -> int:
    """The address of a component's native kernel: `int64 (stage, p*, u*, x*, y*, dt)`.

    Errors: InvalidComponent if the component is not native code.
    """
    return int(_kernel(component).address)


@cache
def _kernel(component: Primitive) -> Any:
    try:
        return native("kernels", component.source + _footer(component), component.shown, "kernel", _SIGNATURE)
    except NumbaError as error:
        raise InvalidComponent(_explained(error, component)) from error


def _footer(component: Primitive) -> str:
    used = [name for name in _ARGUMENTS if name in component.functions]
    cls = component.cls.__name__
    functions = [f'_{n} = _njit({cls}.__dict__["{n}"].__func__, **_OPTIONS)' for n in used]
    calls = [
        f"        if stage == {stage}:\n            _{name}({_ARGUMENTS[name]})"
        for stage, name in ((START, "start"), (OUTPUT, "output"), (UPDATE, "update"))
        if name in used
    ]
    helpers = re.findall(r"^def (\w+)", component.source, re.MULTILINE)
    return _FOOTER.format(
        parameters=_layout(dict.fromkeys(component.parameters) | {n: s.size for n, s in component.series.items()}),
        inputs=_layout(dict.fromkeys(component.inputs)),
        states=_layout({name: state.size for name, state in component.states.items()}),
        outputs=_layout(dict.fromkeys(component.outputs)),
        helpers="\n".join(f"{name} = _njit({name}, **_OPTIONS)" for name in helpers),
        functions="\n".join(functions),
        calls="\n".join(calls) or "        pass",
    )


def _layout(fields: dict[str, int | None]) -> list[tuple[str, str] | tuple[str, str, tuple[int]]]:
    """A record of doubles, some of them arrays; never empty, as a record must have a field."""
    made: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for name, size in fields.items():
        made.append((name, "f8") if size is None else (name, "f8", (size,)))
    return made or [("_nothing", "f8")]


def _explained(error: NumbaError, component: Primitive) -> Fault:
    """The first sentence of the compiler, and the line it is about."""
    text = re.sub(r"\x1b\[[0-9;]*m", "", str(error))
    lines = [int(n) for n in re.findall(r'File ".*?", line (\d+)', text)]
    source = component.source.splitlines()
    line = next((n for n in lines if n <= len(source)), 0)
    reasons = [row.strip() for row in text.splitlines() if row.strip()]
    said = next((r for r in reasons if not r.startswith(("Failed in", "File", "During", "-", ">"))), "")
    shown = source[line - 1] if line else ""
    column = len(shown) - len(shown.lstrip()) + 1 if line else 0
    why = f"numba says: {said.rstrip('.:')}"
    message = f"this cannot become native code; write it with numbers, if, for and math only ({why})."
    return Fault(message, Mark(component.shown, line, column, shown))
