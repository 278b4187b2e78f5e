"""One component on plain numbers, without a model around it, in native code or in Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from gaitsim.compiler.kernel import STAGES, native_function
from gaitsim.compiler.program import Floats
from gaitsim.components.load import function_of
from gaitsim.components.primitive import Primitive
from gaitsim.errors import did_you_mean
from gaitsim.simulation.run import Mode
from gaitsim.simulation.view import View
from gaitsim.units import parse_unit


class Trial:
    """The p, u, x and y of one component in SI. Parameters have their defaults; all other numbers are 0."""

    def __init__(self, kind: Primitive) -> None:
        self.kind = kind
        homes: list[Mapping[str, Any]] = [kind.parameters | kind.series, kind.inputs, kind.states, kind.outputs]
        self.homes = homes
        self.arrays: list[Floats] = []
        self.places: list[dict[str, int | slice]] = []
        for declared in homes:
            places: dict[str, int | slice] = {}
            end = 0
            for name, one in declared.items():
                size = getattr(one, "size", None)
                places[name] = end if size is None else slice(end, end + size)
                end += size or 1
            self.arrays.append(np.zeros(max(end, 1)))
            self.places.append(places)
        self._look()
        for declared, view in zip(homes[:2], self.views, strict=False):
            for name, one in declared.items():
                if getattr(one, "default", None) is not None:
                    setattr(view, name, parse_unit(one.unit).to_si(one.default))

    def _look(self) -> None:
        """Views of the tables."""
        self.views = [View(table, places) for table, places in zip(self.arrays, self.places, strict=True)]
        self.p, self.u, self.x, self.y = self.views

    def put(self, values: Mapping[str, Any]) -> Trial:
        """Set parameters, inputs and states by name, and outputs that MuJoCo sets in a model.

        Args:
            values: Values in SI by name.

        Returns:
            This object.

        Raises:
            KeyError: A name is not declared.
        """
        for name, value in values.items():
            view = next((v for home, v in zip(self.homes, self.views, strict=True) if name in home), None)
            if view is None:
                known = [known for home in self.homes for known in home]
                raise KeyError(f"{self.kind.reference} declares no {name}. {did_you_mean(name, known)}")
            setattr(view, name, value)
        return self

    def copy(self) -> Trial:
        """A copy with tables of its own."""
        made = Trial.__new__(Trial)
        made.kind, made.homes, made.places = self.kind, self.homes, self.places
        made.arrays = [table.copy() for table in self.arrays]
        made._look()
        return made

    def call(self, stage: str, mode: Mode = "rapid", dt: float = 1e-3) -> bool:
        """Call start, output, update or reset on the tables.

        Args:
            stage: The name of the function.
            mode: Native code ("rapid") or plain Python ("normal").
            dt: The step in s; for reset, the time of the event.

        Returns:
            Whether it raised an exception.
        """
        if mode == "rapid":
            kernel, pointers = self._native
            return bool(kernel(STAGES[stage], *pointers, dt))
        p, u, x, y = self.views
        arguments = {"start": (p, u, x), "output": (p, u, x, y)}.get(stage, (p, u, x, y, dt))
        try:
            with np.errstate(all="ignore"):
                function_of(self.kind.cls, stage)(*arguments)
        except Exception:
            return True
        return False

    @cached_property
    def _native(self) -> tuple[Callable[..., int], list[int]]:
        """The native function and the addresses of the tables, which stay where they are."""
        return native_function(self.kind), [table.ctypes.data for table in self.arrays]

    @property
    def stages(self) -> list[str]:
        """The functions among start, output, update and reset that the component has."""
        return [stage for stage in STAGES if stage in self.kind.functions]
