"""One component called on plain arrays, natively and as Python, without any model around it."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from gaitsim.compiler.kernel import OUTPUT, START, UPDATE, address_of
from gaitsim.parts.composite import Composite
from gaitsim.parts.find import Library, shipped_folder
from gaitsim.parts.load import function_of
from gaitsim.parts.primitive import Primitive
from gaitsim.simulation.view import View
from gaitsim.units import parse_unit

FOLDER = shipped_folder()
FILES = sorted(path for path in FOLDER.glob("*/*") if path.suffix in (".py", ".yaml") and path.stem != "kind")
STAGES = {"start": START, "output": OUTPUT, "update": UPDATE}
_C_FUNCTION = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, *[ctypes.c_void_p] * 4, ctypes.c_double)


def reference_of(path: Path) -> str:
    return f"{path.parent.name}/{path.stem}"


@cache
def component(reference: str) -> Primitive | Composite:
    return Library((FOLDER,)).find(reference)


def primitive(reference: str) -> Primitive:
    found = component(reference)
    assert isinstance(found, Primitive)
    return found


def stages(kind: Primitive) -> list[str]:
    """The functions of a component that run in both modes."""
    return [stage for stage in STAGES if stage in kind.functions]


class Tables:
    """The p, u, x, y of one component: four arrays and the views that Python functions get."""

    def __init__(self, kind: Primitive) -> None:
        self.kind = kind
        sizes = (
            dict.fromkeys(kind.parameters, None),
            dict.fromkeys(kind.inputs, None),
            {name: state.size for name, state in kind.states.items()},
            dict.fromkeys(kind.outputs, None),
        )
        self.arrays, self.views = [], []
        for fields in sizes:
            places: dict[str, int | slice] = {}
            end = 0
            for name, size in fields.items():
                places[name] = end if size is None else slice(end, end + size)
                end += size or 1
            table = np.zeros(max(end, 1))
            self.arrays.append(table)
            self.views.append(View(table, places))
        self.p, self.u, self.x, self.y = self.views
        for declared, view in ((kind.parameters, self.p), (kind.inputs, self.u)):
            for name, one in declared.items():
                if one.default is not None:
                    setattr(view, name, one.default * parse_unit(one.unit).factor)

    def put(self, values: Mapping[str, Any]) -> Tables:
        """Set parameters, inputs and states by name (an output by name if nothing else has it)."""
        for name, value in values.items():
            homes = (self.kind.parameters, self.kind.inputs, self.kind.states, self.kind.outputs)
            view = next(v for h, v in zip(homes, self.views, strict=True) if name in h)
            setattr(view, name, value)
        return self

    def copy(self) -> Tables:
        made = Tables(self.kind)
        for mine, theirs in zip(made.arrays, self.arrays, strict=True):
            mine[:] = theirs
        return made

    def call(self, stage: str, mode: str, dt: float = 1e-3) -> bool:
        """Run one function in place; whether it raised."""
        if mode == "rapid":
            kernel = _C_FUNCTION(address_of(self.kind))
            pointers = [table.ctypes.data for table in self.arrays]
            return bool(kernel(STAGES[stage], *pointers, dt))
        p, u, x, y = self.views
        arguments = {"start": (p, u, x), "output": (p, u, x, y), "update": (p, u, x, y, dt)}[stage]
        try:
            with np.errstate(all="ignore"):
                function_of(self.kind.cls, stage)(*arguments)
        except Exception:
            return True
        return False


def computed(reference: str, mode: str = "rapid", /, **values: Any) -> View:
    """The outputs of a component for these parameters, inputs, states and MuJoCo's numbers."""
    tables = Tables(primitive(reference)).put(values)
    assert not tables.call("output", mode)
    return tables.y


def metrics(reference: str, signals: Mapping[str, Any], dt: float, /, **values: Any) -> dict[str, float]:
    """What a measure reports of hand-made signals: native calls, one a sample."""
    kind = primitive(reference)
    tables = Tables(kind).put(values)
    samples = [dict(zip(signals, row, strict=True)) for row in zip(*signals.values(), strict=True)]
    tables.put(samples[0])
    if "start" in kind.functions:
        assert not tables.call("start", "rapid")
    for sample in samples:
        tables.put(sample)
        for stage in ("output", "update"):
            if stage in kind.functions:
                assert not tables.call(stage, "rapid", dt)
    found: dict[str, float] = {}

    class Metrics:
        def __setattr__(self, name: str, value: float) -> None:
            found[name] = float(value)

    function_of(kind.cls, "finish")(tables.p, tables.x, Metrics())
    return found
