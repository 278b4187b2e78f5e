"""The bibliography of the library as a page, and links to it."""

from __future__ import annotations

import re
from functools import cache

from parts_of_text import Page, escaped

from gaitsim.components.bibliography import keys_of, read_bibliography
from gaitsim.distribution import shipped_folder

PATH = "reference/bibliography.md"
_FIELD = re.compile(r"^\s*(\w+)\s*=\s*\{(.*?)\},?\s*$", re.MULTILINE | re.DOTALL)
_HEAD = """\
# Bibliography

Each `source` of a parameter names an entry of `library/references.bib`. `gaitsim cite SPEC` prints the entries
that a model uses.

"""


def linked(source: str, depth: int = 2) -> str:
    """A source with each of its keys linked to the bibliography.

    Args:
        source: What a declaration says, such as `geyer2003`.
        depth: How many folders below docs/ the page lies.

    Returns:
        Markdown.
    """
    text = escaped(source)
    for key in keys_of(source):
        if key in _entries():
            up = "../" * depth
            text = text.replace(escaped(key), f"[{escaped(key)}]({up}{PATH}#{key})", 1)
    return text


def page() -> Page:
    """Every entry of the bibliography, sorted by its key."""
    return Page(PATH, _HEAD + "\n".join(_item(key, text) for key, text in sorted(_entries().items())))


@cache
def _entries() -> dict[str, str]:
    return read_bibliography((shipped_folder(),))


def _item(key: str, text: str) -> str:
    fields = {name.lower(): _plain(value) for name, value in _FIELD.findall(text)}
    authors = fields.get("author", "").replace(" and ", "; ")
    venue = next((fields[name] for name in ("journal", "booktitle", "publisher", "howpublished") if name in fields), "")
    where = " ".join(word for word in (venue, fields.get("volume", ""), fields.get("pages", "")) if word)
    doi = fields.get("doi", "")
    link = f" [doi:{escaped(doi)}](https://doi.org/{doi})" if doi else ""
    words = ". ".join(escaped(word.rstrip(".")) for word in (authors, fields.get("title", ""), where) if word)
    return f"### {escaped(key)} {{#{key}}}\n\n{words} ({fields.get('year', 'no year')}).{link}\n"


def _plain(value: str) -> str:
    """A field of BibTeX without its braces and commands for letters."""
    text = re.sub(r"\\[`'^\"~=.cvuH]?\s*", "", value)
    return " ".join(re.sub(r"[{}]", "", text).replace("--", "–").split())
