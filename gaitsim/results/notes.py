"""A researcher's notes about a result: the section Notes of its README. No digest covers them."""

from __future__ import annotations

from pathlib import Path

from gaitsim.results.readme import NOTES
from gaitsim.results.store import CannotSave
from gaitsim.whole import write_whole

_README = "README.md"


def notes_of(folder: Path) -> str:
    """The notes of a result; empty if there are none."""
    try:
        text = (folder / _README).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return ""
    return text.partition(NOTES)[2].strip()


def add_note(folder: Path, text: str, author: str, day: str) -> None:
    """Append a note.

    Args:
        folder: The result.
        text: The note.
        author: Who writes it.
        day: The date.

    Raises:
        CannotSave: The README cannot be read or written. It is unchanged.
    """
    path = folder / _README
    try:
        before = path.read_text(encoding="utf-8") if path.is_file() else ""
        lines = "\n  ".join(text.strip().splitlines())
        whole = before if NOTES in before else f"{before.rstrip()}\n\n{NOTES}\n"
        write_whole(path, f"{whole.rstrip()}\n\n- {day}, {author}: {lines}\n")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise CannotSave(f"{path}: the note cannot be added ({reason}); make the file one that can be written.") from error
