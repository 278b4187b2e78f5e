"""Remembers which component files the audit found sound: they are not audited again."""

from __future__ import annotations

import contextlib
import hashlib
import os
import sys
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


def is_sound(source: str) -> bool:
    """Whether the audit, as it is now, has found no fault in this text."""
    return _stamp(source).is_file()


def remember(source: str) -> None:
    """The audit has found no fault in this text. Where nothing can be written, it is audited again."""
    stamp = _stamp(source)
    with contextlib.suppress(OSError):
        stamp.parent.mkdir(parents=True, exist_ok=True)
        stamp.touch()


def _stamp(source: str) -> Path:
    return cache_root() / "audited" / hashlib.sha256(f"{_rules()}|{source}".encode()).hexdigest()[:24]


@cache
def _rules() -> str:
    """The digest of all that the audit's answer depends on besides the text."""
    folder = Path(gaitsim.__file__).parent
    digest = hashlib.sha256(sys.version.encode())
    for path in sorted(path for pattern in _RULES for path in folder.glob(pattern)):
        digest.update(path.read_bytes())
    return digest.hexdigest()
