"""Markdown for the generated pages: escaped text, tables, numbers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

_SPECIAL = re.compile(r"([\\`*_{}\[\]<>#|~^$])")


class Page(NamedTuple):
    """A generated file: its path below docs/, and its text or bytes."""

    path: str
    content: str | bytes


def escaped(text: str) -> str:
    """A text from a declaration, so that Markdown shows it as it is."""
    return _SPECIAL.sub(r"\\\1", text)


def paragraphs(text: str) -> str:
    """Paragraphs from a docstring: lines within a paragraph are joined."""
    pieces = (" ".join(piece.split()) for piece in re.split(r"\n\s*\n", text))
    return "\n\n".join(escaped(piece) for piece in pieces)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table; cells are Markdown already. Columns without any content are left out."""
    cells = [list(row) for row in rows]
    kept = [i for i in range(len(heads)) if any(row[i] for row in cells)]
    lines = [[heads[i] for i in kept], ["---"] * len(kept), *([row[i] for i in kept] for row in cells)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def number(value: Any) -> str:
    """A number, a text or a pair of them in the shortest form; empty for None."""
    if value is None:
        return ""
    if isinstance(value, list | tuple):
        return " to ".join(number(item) for item in value)
    if isinstance(value, float | int) and not isinstance(value, bool):
        return f"{value:g}"
    return escaped(str(value))


def code(text: str) -> str:
    """Code within a line; empty for an empty text."""
    return f"`{text}`" if text else ""
