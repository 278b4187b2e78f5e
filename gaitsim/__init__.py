"""gaitsim: neuromuscular gait models from YAML, simulated in native code.

In a notebook: `gaitsim.load("results/2026-11-22-hopping-3f9c").trajectory()`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from gaitsim.study.result import Result

__version__ = "0.1.0"
__all__ = ["__version__", "load"]


def load(folder: str | Path, candidate: str = "best", trust: bool = False) -> Result:
    """A result folder: its record, and its signals as labelled arrays with units.

    candidate: best, a rank, or GENERATION:INDEX of a search; of a study best, or the number of a run.
    trust: run components that this machine does not know. Errors: gaitsim.errors.GaitsimError.
    """
    from gaitsim.study.result import load

    return load(folder, candidate, trust)
