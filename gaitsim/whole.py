"""Files that are complete or absent: a draft is written beside the file, then renamed to it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

PARTIAL = ".partial"  # the ending of a draft's name


def draft_of(path: Path) -> Path:
    """The path of the draft of a file or a folder."""
    return path.with_name(f"{path.name}{PARTIAL}")


@contextmanager
def whole(path: Path, draft: Path | None = None) -> Iterator[Path]:
    """Replace a file by a draft at the end of the block.

    Args:
        path: The file.
        draft: Another path for the draft, for a file that several processes may write at once.

    Yields:
        The path of the draft, to be written within the block.

    Raises:
        OSError: Writing failed. The draft is removed, and the file is unchanged.
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
    """Write a text file completely.

    Args:
        path: The file.
        text: Its new content.

    Raises:
        OSError: Writing failed. The file is unchanged.
    """
    with whole(path) as draft:
        draft.write_text(text, encoding="utf-8")


def flush_to_disk(file: IO[str] | IO[bytes]) -> None:
    """Flush a file to the disk, so that its content survives a crash of the machine.

    Args:
        file: An open file.

    Raises:
        OSError: The disk cannot be written.
    """
    file.flush()
    os.fsync(file.fileno())
