"""Files that are whole or absent: written as a draft beside their place, then renamed onto it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

PARTIAL = ".partial"  # how the name of a draft ends


def draft_of(path: Path) -> Path:
    """Where the draft of a file or a folder lies."""
    return path.with_name(f"{path.name}{PARTIAL}")


@contextmanager
def whole(path: Path, draft: Path | None = None) -> Iterator[Path]:
    """The draft of a file, which takes its place at the end of the block.

    Args:
        draft: One of a name of its own, where several processes may write the same file.

    Raises:
        OSError: With no draft left behind and what stood there before as it was.
    """
    beside = draft or draft_of(path)
    try:
        yield beside
        beside.replace(path)
    except OSError:
        with suppress(OSError):
            beside.unlink()
        raise


def write_whole(path: Path, text: str) -> None:
    """Write a text as a whole.

    Raises:
        OSError: With what stood there before as it was.
    """
    with whole(path) as draft:
        draft.write_text(text, encoding="utf-8")


def onto_disk(file: IO[str] | IO[bytes]) -> None:
    """Make sure that what was written is on the disk, so that a crash of the machine leaves it.

    Raises:
        OSError: The file cannot be read or written.
    """
    file.flush()
    os.fsync(file.fileno())
