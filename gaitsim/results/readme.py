"""README.md of a result: name, origin, headline numbers, and the researcher's own notes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

NOTES = "## Notes"


def readme(manifest: dict[str, Any], headline: Sequence[str], before: str) -> str:
    """The text; notes that stand in the one before are kept."""
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
