"""A researcher's own words about a result: below the heading Notes of its README, which no digest covers."""

from __future__ import annotations

from pathlib import Path

from gaitsim.results.readme import NOTES
from gaitsim.results.store import CannotSave
from gaitsim.whole import write_whole

_README = "README.md"


def notes_of(folder: Path) -> str:
    """The notes of a result; nothing if there are none."""
    try:
        text = (folder / _README).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return ""
    return text.partition(NOTES)[2].strip()


def add_note(folder: Path, text: str, author: str, day: str) -> None:
    """Add a note below those that are there, with its author and day.

    Raises:
        CannotSave: The README cannot be read or written; it is then as it was.
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
