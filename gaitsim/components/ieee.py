"""Mathematical functions that behave like native code: outside of their domain they return nan or inf instead of
raising.

Plain Python raises an exception for sqrt(-1) and exp(800). Component files get these functions instead of `math` when
they run as Python, so that normal mode and rapid mode agree.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

_FLOAT = np.float64


def ieee_math() -> SimpleNamespace:
    """The names of `math`, each defined for all floats."""
    names = {name: getattr(math, name) for name in dir(math) if not name.startswith("_")}
    return SimpleNamespace(
        **{name: _total(value, _out_of_range(name)) if callable(value) else value for name, value in names.items()}
    )


def _out_of_range(name: str) -> Callable[..., float]:
    grows: dict[str, Callable[..., float]] = {
        "exp": lambda x: math.inf,
        "exp2": lambda x: math.inf,
        "expm1": lambda x: math.inf,
        "cosh": lambda x: math.inf,
        "sinh": lambda x: math.copysign(math.inf, x),
        "log": lambda x, *base: -math.inf if x == 0 else math.nan,
        "log10": lambda x: -math.inf if x == 0 else math.nan,
        "log2": lambda x: -math.inf if x == 0 else math.nan,
        "log1p": lambda x: -math.inf if x == -1 else math.nan,
        "atanh": lambda x: math.copysign(math.inf, x) if abs(x) == 1 else math.nan,
        "pow": lambda x, y: float(np.power(_FLOAT(x), _FLOAT(y))),
    }
    return grows.get(name, lambda *x: math.nan)


def _total(function: Callable[..., Any], otherwise: Callable[..., float]) -> Callable[..., Any]:
    def total(*arguments: Any) -> Any:
        try:
            value = function(*arguments)
        except (ValueError, OverflowError):
            value = otherwise(*arguments)
        return _FLOAT(value) if isinstance(value, float) else value

    return total
