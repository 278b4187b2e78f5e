"""A small search, and the files of its result."""

from __future__ import annotations

from pathlib import Path

SMALL = ("--workers", "0", "--set", "simulate.duration=20ms", "--population", "3", "--generations", "2")


def content(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def lines(files: dict[str, bytes]) -> set[bytes]:
    """Every evaluation, in whichever journal."""
    return {line for name, text in files.items() if name.endswith(".jsonl") for line in text.splitlines()}


def rewritten(path: Path, *changes: tuple[str, str]) -> None:
    text = path.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
