"""Tables as lines of text. No library is used, because loading one takes as long as a short run."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Sequence
from itertools import zip_longest

_EDGE, _GAP = " ", "  "
_LEAST = 4  # letters of a column, however narrow the terminal is


def rows_of(columns: Sequence[str], rows: Sequence[Sequence[str]], width: int | None = None) -> Iterator[list[str]]:
    """The lines of the heading and of each row of a table. A cell may have several lines.

    Args:
        columns: The headings.
        rows: The cells of each row.
        width: The width of the terminal, to which long cells are folded; None folds nothing.
    """
    cells = [[cell.expandtabs().splitlines() or [""] for cell in row] for row in (columns, *rows)]
    widths = [max(_width(line) for cell in column for line in cell) for column in zip(*cells, strict=True)]
    if width is not None:
        _narrow(widths, width - len(_EDGE) - len(_GAP) * (len(widths) - 1))
    for row in cells:
        folded = [[part for line in cell for part in _folded(line, w)] for cell, w in zip(row, widths, strict=True)]
        yield [_line(pieces, widths) for pieces in zip_longest(*folded, fillvalue="")]


def _line(pieces: Sequence[str], widths: Sequence[int]) -> str:
    padded = (text + " " * (width - _width(text)) for text, width in zip(pieces, widths, strict=True))
    return (_EDGE + _GAP.join(padded)).rstrip()


def _narrow(widths: list[int], room: int) -> None:
    """Make the widest columns narrower until all fit."""
    while sum(widths) > room and max(widths) > _LEAST:
        widths[widths.index(max(widths))] -= 1


def _folded(text: str, most: int) -> Iterator[str]:
    """Pieces of a line up to a width, divided between words where possible."""
    while _width(text) > most:
        end = next(i for i in range(len(text), 0, -1) if i == 1 or _width(text[:i]) <= most)
        space = end if text[end] == " " else text.rfind(" ", 0, end)
        yield text[: space if space > 0 else end].rstrip()
        text = text[space + 1 if space > 0 else end :].lstrip()
    yield text


def _width(text: str) -> int:
    """The number of columns that a text takes on a terminal: two for some East Asian letters, none for combining
    accents.
    """
    if text.isascii():
        return len(text)
    return sum(2 if unicodedata.east_asian_width(c) in "WF" else not unicodedata.combining(c) for c in text)
