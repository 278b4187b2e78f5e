"""The user's own folders: a cache of what can be made again, what gaitsim must remember, and results.

The first two hold what decides which code runs, so neither is ever looked for from the current folder.
"""

from __future__ import annotations

import os
from pathlib import Path


def cache_folder() -> Path | None:
    """$GAITSIM_CACHE, or gaitsim's folder in the user's cache; None where there is no absolute path to it."""
    if own := os.environ.get("GAITSIM_CACHE"):
        return _absolute(own)
    return _below("XDG_CACHE_HOME", ".cache")


def state_folder() -> Path | None:
    """The folder gaitsim in $GAITSIM_STATE, or in the user's state; None where there is no absolute path to it."""
    if own := os.environ.get("GAITSIM_STATE"):
        return _absolute(f"{own}/gaitsim")
    return _below("XDG_STATE_HOME", ".local/state")


def results_folder(said: Path | None = None) -> Path:
    """Where results are: the folder that was said, or else $GAITSIM_RESULTS, or results in the current folder."""
    return said if said is not None else Path(os.environ.get("GAITSIM_RESULTS") or "results")


def _below(variable: str, usual: str) -> Path | None:
    """Our folder where the XDG base directory specification puts it; a relative path says nothing there."""
    said = Path(os.environ.get(variable, ""))
    if said.is_absolute():
        return said / "gaitsim"
    try:
        return _absolute(f"{Path.home()}/{usual}/gaitsim")
    except RuntimeError:  # neither $HOME nor an entry in the list of users
        return None


def _absolute(said: str) -> Path | None:
    return Path(said) if Path(said).is_absolute() else None
