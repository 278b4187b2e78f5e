"""A cache of checked component files: sound files are neither checked nor parsed again."""

from __future__ import annotations

import hashlib
import json
import sys
from functools import cache
from pathlib import Path

import gaitsim
from gaitsim.cache import cached, keep
from gaitsim.components.checks.findings import Findings

_RULES = ("component.py", "units.py", "components/*.py", "components/checks/*.py", "text/expression.py")


def sound_findings(text: str) -> Findings | None:
    """Look up a text that was found free of faults.

    Args:
        text: The text of the component and of its shared files.

    Returns:
        What was found in it; None if the text is not in the cache.
    """
    known = cached("audited", _key(text))
    if known is None:
        return None
    found = json.loads(known)
    needed = {str(output): frozenset(map(str, inputs)) for output, inputs in found["dependencies"].items()}
    return Findings(needed, bool(found["may_raise"]), bool(found["open_loop"]))


def remember(text: str, findings: Findings) -> None:
    """Store that a text has no fault. If the cache cannot be written, the text is checked again next time."""
    needed = {output: sorted(inputs) for output, inputs in findings.dependencies.items()}
    keep("audited", _key(text), json.dumps(vars(findings) | {"dependencies": needed}).encode())


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
