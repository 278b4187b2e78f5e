"""The user's own folders: the cache, the state that gaitsim must remember, and results.

Cache and state decide which code runs. They are therefore never looked up relative to the current folder.
"""

from __future__ import annotations

import os
from pathlib import Path


def cache_folder() -> Path | None:
    """Find the cache folder.

    Returns:
        $GAITSIM_CACHE, or the folder of gaitsim in the user's cache; None if neither is an absolute path.
    """
    if own := os.environ.get("GAITSIM_CACHE"):
        return _absolute(own)
    return _below("XDG_CACHE_HOME", ".cache")


def state_folder() -> Path | None:
    """Find the folder of what gaitsim must remember.

    Returns:
        The folder gaitsim in $GAITSIM_STATE or in the user's state; None if neither is an absolute path.
    """
    if own := os.environ.get("GAITSIM_STATE"):
        return _absolute(f"{own}/gaitsim")
    return _below("XDG_STATE_HOME", ".local/state")


def results_folder(folder: Path | None = None) -> Path:
    """Find the folder of results.

    Args:
        folder: The folder that the user named, if any.

    Returns:
        That folder, or else $GAITSIM_RESULTS, or else results in the current folder.
    """
    return folder if folder is not None else Path(os.environ.get("GAITSIM_RESULTS") or "results")


def analysis_folder(folder: Path | None = None) -> Path:
    """Where what is drawn of specs goes: analysis in the folder of the results, if one was said; else analysis here."""
    return (results_folder(folder) if folder is not None or os.environ.get("GAITSIM_RESULTS") else Path()) / "analysis"


def _below(variable: str, usual: str) -> Path | None:
    """The folder of gaitsim by the XDG base directory specification, which does not allow relative paths."""
    named = Path(os.environ.get(variable, ""))
    if named.is_absolute():
        return named / "gaitsim"
    try:
        return _absolute(f"{Path.home()}/{usual}/gaitsim")
    except RuntimeError:  # neither $HOME nor an entry in the password database
        return None


def _absolute(path: str) -> Path | None:
    return Path(path) if Path(path).is_absolute() else None
