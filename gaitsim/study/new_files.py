"""New files of a user: all are written, or none, and none replaces an existing one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path


def write_new(files: Mapping[Path, str], move: str) -> None:
    """Write texts to new files, with their folders.

    Args:
        files: Texts by path.
        move: What the message suggests if this fails.

    Raises:
        CannotSave: A file exists or cannot be written. Nothing is left behind.
    """
    from gaitsim.results.store import CannotSave

    taken = [path for path in files if path.exists()]
    if taken:
        rule = "exists already and is never overwritten; choose another name, or move it away"
        raise CannotSave(f"{taken[0]}: this {rule}.")
    made: list[Path] = []
    try:
        for path, text in files.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("x", encoding="utf-8") as file:
                made.append(path)
                file.write(text)
    except OSError as error:
        for path in made:
            path.unlink(missing_ok=True)
        raise CannotSave(f"{error.filename or made[-1]}: {error.strerror}; {move}.") from error
