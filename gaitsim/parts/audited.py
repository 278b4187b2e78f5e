"""Remembers which component files were found sound, and what their outputs depend on: they are not checked again."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import secrets
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import gaitsim

_RULES = ("component.py", "units.py", "parts/*.py", "spec/expression.py")


def cache_root() -> Path:
    """Where gaitsim keeps what it can make again: $GAITSIM_CACHE, or its folder in the user's cache."""
    if own := os.environ.get("GAITSIM_CACHE"):
        return Path(own)
    root = os.environ.get("XDG_CACHE_HOME")
    return (Path(root) if root else Path.home() / ".cache") / "gaitsim"


def sound_dependencies(source: str) -> dict[str, frozenset[str]] | None:
    """The inputs that each output needs, of a text in which these checks have found no fault before; else None."""
    try:
        known = json.loads(_memory(source).read_text(encoding="utf-8"))
        return {str(output): frozenset(map(str, inputs)) for output, inputs in known.items()}
    except (OSError, ValueError, AttributeError, TypeError):
        return None


def remember(source: str, dependencies: Mapping[str, frozenset[str]]) -> None:
    """This text has no fault. Where nothing can be written, it is checked again."""
    memory = _memory(source)
    draft = memory.with_name(f"{memory.name}.{secrets.token_hex(4)}")
    with contextlib.suppress(OSError):
        memory.parent.mkdir(parents=True, exist_ok=True)
        draft.write_text(json.dumps({name: sorted(inputs) for name, inputs in dependencies.items()}), encoding="utf-8")
        draft.replace(memory)


def _memory(source: str) -> Path:
    return cache_root() / "audited" / f"{hashlib.sha256(f'{_rules()}|{source}'.encode()).hexdigest()[:24]}.json"


@cache
def _rules() -> str:
    """The digest of all that the answer depends on besides the text."""
    folder = Path(gaitsim.__file__).parent
    digest = hashlib.sha256(sys.version.encode())
    for path in sorted(path for pattern in _RULES for path in folder.glob(pattern)):
        digest.update(path.read_bytes())
    return digest.hexdigest()
