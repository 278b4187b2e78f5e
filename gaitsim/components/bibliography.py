"""The references of a library: BibTeX entries by key, and the keys that sources name."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from gaitsim.errors import nearest

FILE = "references.bib"
_HEAD = re.compile(r"^@(\w+)\s*\{\s*([^,\s]+)\s*,", re.MULTILINE)
_KEY = re.compile(r"(?=[a-z_]*\d)[A-Za-z]\w*")


def read_bibliography(folders: Iterable[Path]) -> dict[str, str]:
    """Read the `references.bib` files of a library.

    Args:
        folders: The folders of the library, nearest first.

    Returns:
        BibTeX entries by key; the nearest folder with a key counts.
    """
    found: dict[str, str] = {}
    for folder in folders:
        path = folder / FILE
        if path.is_file():
            found = entries(path.read_text(encoding="utf-8")) | found
    return found


def entries(text: str) -> dict[str, str]:
    """The entries of a BibTeX text by key, unchanged."""
    return {head[2]: _entry(text, head.start()) for head in _HEAD.finditer(text)}


def keys_of(source: str) -> list[str]:
    """The keys in a source: words of letters followed by digits, before the first colon."""
    return [word for word in re.findall(r"\w+", source.split(":")[0]) if _KEY.fullmatch(word)]


def unknown_key(key: str, keys: set[str]) -> str:
    """The message for a key that is not in the bibliography."""
    near = nearest(key, keys)
    hint = f"Did you mean {near}?" if near else f"Add it to {FILE} of your library."
    return f"the source {key} is in no {FILE}. {hint}"


def _entry(text: str, start: int) -> str:
    """The text from an @ to the closing brace of its entry."""
    depth = 0
    for i in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[i], 0)
        if text[i] == "}" and depth == 0:
            return text[start : i + 1]
    return text[start:]
