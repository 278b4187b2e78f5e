"""Removal of results."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from gaitsim.results.lock import Lock
from gaitsim.results.manifest import BadResult, check_is_result
from gaitsim.results.store import CannotSave
from gaitsim.whole import PARTIAL


def remove(folder: Path) -> None:
    """Remove a result with all its files, completely or not at all.

    Raises:
        BadResult: The folder is not a result, or is a link to one.
        Locked: A search or a run is writing it.
        CannotSave: It cannot be removed.
    """
    check_is_result(folder)
    if folder.is_symlink():
        raise BadResult(f"{folder}: this is a link to {folder.resolve()}; remove that, or the link by hand.")
    aside = folder.with_name(f"{folder.name}.{os.getpid()}{PARTIAL}")
    try:
        with Lock(folder):
            folder.rename(aside)
        shutil.rmtree(aside)
    except OSError as error:
        reason = error.strerror or str(error)
        raise CannotSave(f"{folder}: this cannot be removed ({reason}); make the folder one that can be changed.") from error
