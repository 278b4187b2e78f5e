"""README.md of a result: name, origin, main numbers, and the researcher's notes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

NOTES = "## Notes"


def readme(manifest: dict[str, Any], headline: Sequence[str], before: str) -> str:
    """The text of the README.

    Args:
        manifest: The manifest.
        headline: Lines with the main numbers.
        before: The present README, whose notes are kept.
    """
    commit = manifest.get("commit")
    origin = f"commit {commit['hash'][:12]}{' with changes' if commit['dirty'] else ''}" if commit else "no commit"
    _, _, notes = before.partition(NOTES)
    lines = [
        f"# {manifest['name']}",
        "",
        f"gaitsim {manifest['gaitsim']}, {manifest['created']}, {origin}, status {manifest['status']}.",
        "",
        *(f"- {line}" for line in headline),
        "",
        f"{NOTES}{notes}" if notes else f"{NOTES}\n",
    ]
    return "\n".join(lines)
