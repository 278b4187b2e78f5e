"""Which component files this machine knows: its libraries' own, and those that it ran before."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable
from pathlib import Path

from gaitsim.errors import GaitsimError
from gaitsim.parts.find import library_folders, shown
from gaitsim.parts.load import digest_of
from gaitsim.results.bundle import COMPONENTS


class Untrusted(GaitsimError):
    """A result holds code that this machine has not seen."""


def remember(folder: Path) -> None:
    """Note that a result's components were run here."""
    known = _known_here()
    new = [digest for digest in _digests(_code_in(folder / COMPONENTS)) if digest not in known]
    if new:
        path = _memory()
        # Where this cannot be written, the result asks for --trust later: no reason to end a run now.
        with contextlib.suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("a", encoding="utf-8") as file:
                file.writelines(f"{digest}\n" for digest in new)


def check_trust(folder: Path, trusted: bool) -> None:
    """Let a result's components run only if they are known, or with the user's word.

    Errors: Untrusted.
    """
    known = set(_known_here())
    for library in library_folders(None):
        known |= set(_digests(_code_in(library)))
    strange = [path for path in _code_in(folder / COMPONENTS) if digest_of(path.read_text("utf-8")) not in known]
    if strange and not trusted:
        names = ", ".join(shown(path) for path in strange)
        rule = "running it would run code that this machine does not know"
        raise Untrusted(f"{folder}: {rule}: {names}; read these files, then use --trust.")


def _code_in(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.py")) if folder.is_dir() else []


def _digests(paths: Iterable[Path]) -> list[str]:
    return [digest_of(path.read_text(encoding="utf-8")) for path in paths]


def _known_here() -> set[str]:
    path = _memory()
    return set(path.read_text(encoding="utf-8").split()) if path.is_file() else set()


def _memory() -> Path:
    """The list of digests, in the user's state folder."""
    root = os.environ.get("GAITSIM_STATE") or os.environ.get("XDG_STATE_HOME")
    return (Path(root) if root else Path.home() / ".local" / "state") / "gaitsim" / "known_components"
