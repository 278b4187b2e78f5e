"""Remembers which component files were found sound, and what their outputs depend on: they are not checked again."""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import gaitsim
from gaitsim.cache import keep, kept

_RULES = ("component.py", "units.py", "components/*.py", "components/checks/*.py", "text/expression.py")


def sound_dependencies(text: str) -> dict[str, frozenset[str]] | None:
    """The inputs that each output needs, of a text in which these checks have found no fault before; else None."""
    known = kept("audited", _key(text))
    if known is None:
        return None
    return {str(output): frozenset(map(str, inputs)) for output, inputs in json.loads(known).items()}


def remember(text: str, dependencies: Mapping[str, frozenset[str]]) -> None:
    """This text has no fault. Where nothing can be written, it is checked again."""
    keep("audited", _key(text), json.dumps({name: sorted(inputs) for name, inputs in dependencies.items()}).encode())


def _key(text: str) -> str:
    return hashlib.sha256(f"{_rules()}|{text}".encode()).hexdigest()[:32]


@cache
def _rules() -> str:
    """The digest of all that the answer depends on besides the text."""
    folder = Path(gaitsim.__file__).parent
    digest = hashlib.sha256(sys.version.encode())
    for path in sorted(path for pattern in _RULES for path in folder.glob(pattern)):
        digest.update(path.read_bytes())
    return digest.hexdigest()
