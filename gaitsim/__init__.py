"""gaitsim: neuromuscular gait models from YAML, simulated in native code.

In a notebook: `gaitsim.run("walk.yaml", set={"simulate.duration": "2 s"})`, `gaitsim.optimize("walk.yaml")`,
`gaitsim.load("results/2026-11-22-hopping-3f9c").trajectory()`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gaitsim.study.notebook import analyze, check, optimize, run
    from gaitsim.study.notebook_cohort import cohort
    from gaitsim.study.notebook_limits import cycle, limit
    from gaitsim.study.notebook_results import compare, export_result, import_result
    from gaitsim.study.result import load

__version__ = "0.1.0"
__all__ = [
    "__version__",
    "analyze",
    "check",
    "cohort",
    "compare",
    "cycle",
    "export_result",
    "import_result",
    "limit",
    "load",
    "optimize",
    "run",
]

_HOMES = {
    **dict.fromkeys(("analyze", "check", "optimize", "run"), "gaitsim.study.notebook"),
    **dict.fromkeys(("cycle", "limit"), "gaitsim.study.notebook_limits"),
    **dict.fromkeys(("compare", "export_result", "import_result"), "gaitsim.study.notebook_results"),
    "cohort": "gaitsim.study.notebook_cohort",
    "load": "gaitsim.study.result",
}


def __getattr__(name: str) -> Any:
    """Import a function when it is first used, so that the command line starts without it.

    Args:
        name: The attribute that is asked for.

    Raises:
        AttributeError: gaitsim has no such attribute.
    """
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'gaitsim' has no attribute {name!r}")
