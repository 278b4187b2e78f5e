"""The user's own folders: a cache of what can be made again, and what gaitsim must remember."""

from __future__ import annotations

import os
from pathlib import Path


def cache_folder() -> Path | None:
    """$GAITSIM_CACHE, or gaitsim's folder in the user's cache; None where the user has no home."""
    return _own("GAITSIM_CACHE") or _below("XDG_CACHE_HOME", ".cache")


def state_folder() -> Path | None:
    """The folder gaitsim in $GAITSIM_STATE or in the user's state; None where the user has no home."""
    named = _own("GAITSIM_STATE")
    return named / "gaitsim" if named else _below("XDG_STATE_HOME", ".local/state")


def _own(variable: str) -> Path | None:
    """The folder that a variable of ours names."""
    said = os.environ.get(variable)
    return Path(said).absolute() if said else None


def _below(variable: str, usual: str) -> Path | None:
    """Our folder where the XDG base directory specification puts it; a relative path says nothing there."""
    said = Path(os.environ.get(variable, ""))
    if said.is_absolute():
        return said / "gaitsim"
    try:
        home = Path.home()
    except RuntimeError:  # neither $HOME nor an entry in the list of users
        return None
    return home / usual / "gaitsim" if home.is_absolute() else None
