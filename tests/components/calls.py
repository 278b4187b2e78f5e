"""One component called on plain arrays, natively and as Python, without any model around it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from gaitsim.components.composite import Composite
from gaitsim.components.find import SKELETON, Library, is_component
from gaitsim.components.load import function_of
from gaitsim.components.primitive import Primitive
from gaitsim.distribution import shipped_folder
from gaitsim.simulation.run import Mode
from gaitsim.simulation.trial import Trial as Tables
from gaitsim.simulation.view import View

FOLDER = shipped_folder()
FILES = sorted(path for path in FOLDER.glob("*/*") if is_component(path) or path.name == SKELETON)


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
    return Tables(kind).stages


def computed(reference: str, mode: Mode = "rapid", /, **values: Any) -> View:
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
    found = SimpleNamespace()
    function_of(kind.cls, "finish")(tables.p, tables.x, found)
    return {name: float(value) for name, value in vars(found).items()}
