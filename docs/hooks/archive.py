"""The page of the archive's models, from specs and records."""

from __future__ import annotations

from parts_of_text import Page, code, escaped, table
from references import linked

from gaitsim.cli.archive import COMPARED_COLUMNS, compared_rows
from gaitsim.cli.console import ConsoleListener
from gaitsim.study.archive import archived
from gaitsim.study.catalogue import Entry, entries
from gaitsim.study.known import summary

_HEAD = """\
# Models and how well they do

This page is generated from the specs in `specs/` and their records, as `gaitsim archive list` is. Below the table stand
values known from elsewhere, such as published ones, beside those of the model as it was recorded. `within` says
whether the difference is within the tolerance that the spec states, if it states one. Where words follow the key of a
source, the model is that of the paper, and the words say where the value is from.
"""


def page() -> Page:
    """What each model is, from which papers, and how well it has the values that it should have."""
    found = list(entries(archived([]), ConsoleListener(quiet=True)))
    rows = [[code(e.name), escaped(e.summary), _papers(e), summary(e.reproduces)] for e in found]
    texts = [_HEAD, table(["model", "what it is", "papers", "how well it has known values"], rows)]
    for entry in found:
        if entry.reproduces:
            lines = ([*map(escaped, cells), linked(source, 1)] for *cells, source in compared_rows(entry.reproduces))
            texts += [f"## {entry.name}\n", table(COMPARED_COLUMNS, lines)]
    return Page("reference/models.md", "\n".join(texts))


def _papers(entry: Entry) -> str:
    return ", ".join(linked(key, 1) for key in entry.papers)
