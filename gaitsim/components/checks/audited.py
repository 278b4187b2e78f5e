"""A cache of checked component files: sound files, and the inputs that their outputs depend on, are not computed
again.
"""

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
    """Look up a text that was found free of faults.

    Args:
        text: The text of the component and of its shared files.

    Returns:
        The inputs that each output needs; None if the text is not in the cache.
    """
    known = kept("audited", _key(text))
    if known is None:
        return None
    return {str(output): frozenset(map(str, inputs)) for output, inputs in json.loads(known).items()}


def remember(text: str, dependencies: Mapping[str, frozenset[str]]) -> None:
    """Store that a text has no fault. If the cache cannot be written, the text is checked again next time."""
    keep("audited", _key(text), json.dumps({name: sorted(inputs) for name, inputs in dependencies.items()}).encode())


def _key(text: str) -> str:
    return hashlib.sha256(f"{_rules()}|{text}".encode()).hexdigest()[:32]


@cache
def _rules() -> str:
    """The digest of all code that decides the result of the check."""
    folder = Path(gaitsim.__file__).parent
    digest = hashlib.sha256(sys.version.encode())
    for path in sorted(path for pattern in _RULES for path in folder.glob(pattern)):
        digest.update(path.read_bytes())
    return digest.hexdigest()
