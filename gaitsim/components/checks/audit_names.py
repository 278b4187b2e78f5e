"""The math and the builtins that an audited component file sees: they work on numbers without a value."""

from __future__ import annotations

import builtins
import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from gaitsim.components.checks.dimension_search import Number, Search

# The unit of the result follows from the arguments; all other functions are plain to plain.
_ALIKE = {"hypot": True, "fmod": True, "remainder": True, "atan2": False, "isclose": False}
_ROOTS = {"sqrt": 1 / 2, "cbrt": 1 / 3}
_ANY_TO_PLAIN = {"isnan", "isinf", "isfinite"}
_FIRST = {"fabs", "copysign"}


def namespace(search: Search) -> dict[str, Any]:
    """The global names of an audited file: its math, and the builtins that depend on values."""

    def without_value(plain: Callable[..., Any], either: Callable[..., Any]) -> Callable[..., Any]:
        def called(*values: Any) -> Any:
            return (either if any(isinstance(v, Number) for v in values) else plain)(*values)

        return called

    def rule(name: str) -> Callable[..., Any]:
        function = f"math.{name}"
        if name in _ALIKE:
            return lambda *v: search.alike(f"{function} of {{0}} and {{1}}", *v, keeps=_ALIKE[name])
        if name in _ROOTS:
            return lambda v: search.power(v, _ROOTS[name])
        if name == "pow":
            return search.power
        if name in _ANY_TO_PLAIN:
            return lambda v: Number(search, search.dimensions.plain)
        if name in _FIRST:
            return lambda v, *sign: search.combine("*", v, 1)
        return lambda *v: search.plain(function, *v)

    def turns(*values: Any) -> list[Number]:
        return [search.plain("range", *values) for _ in range(2)]

    def concrete(*values: int) -> list[Number]:
        return [search.plain("range") for _ in range(*values)[:2]]

    def extreme(name: str) -> Callable[..., Any]:
        def either(*v: Any) -> Number:
            return search.alike(f"takes the {name} of {{0}} and {{1}}", *v)

        return without_value(getattr(builtins, name), either)

    def find(name: str, *rest: Any) -> Any:
        return mathematics if name == "math" else builtins.__import__(name, *rest)

    names = {n: v for n, v in vars(math).items() if not n.startswith("_")}
    mathematics = SimpleNamespace(**{n: without_value(v, rule(n)) if callable(v) else v for n, v in names.items()})
    own = {
        "__import__": find,
        "range": without_value(concrete, turns),
        "int": without_value(int, lambda v: search.plain("int", v)),
        "float": without_value(float, lambda v: search.combine("*", v, 1)),
        "min": extreme("min"),
        "max": extreme("max"),
        "print": lambda *values, **options: None,
        "breakpoint": lambda: None,
    }
    return {
        "__name__": "audited",
        "__builtins__": {**vars(builtins), **own},
        "__reach__": search.reach,
        "__each__": search.each,
    }
