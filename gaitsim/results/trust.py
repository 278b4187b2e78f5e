"""Which component files may run unasked: those that come with gaitsim, and those that were run here before.

Where a result lies, and from which folder a command is given, says nothing about who wrote it.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterable

from gaitsim.errors import GaitsimError
from gaitsim.folders import state_folder
from gaitsim.components.find import shipped_folder, shown
from gaitsim.components.load import as_lines, digest_of
from gaitsim.results.bundle import Bundle

_MEMORY = "known_components"


class Untrusted(GaitsimError):
    """A result holds code that this machine has not seen."""


def remember(bundle: Bundle) -> None:
    """Note that a result's components were run here."""
    known, folder = _known_here(), state_folder()
    new = [digest for digest in _code_in(bundle).values() if digest not in known]
    if new and folder is not None:
        # Where this cannot be written, the result asks for --trust later: no reason to end a run now.
        with contextlib.suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            with (folder / _MEMORY).open("a", encoding="utf-8") as file:
                file.writelines(f"{digest}\n" for digest in new)


def check_trust(bundle: Bundle, trusted: bool) -> None:
    """Let a result's components run only if they are known, or with the user's word.

    Raises:
        Untrusted: The result has components that this machine does not trust.
    """
    if trusted:
        return
    strange = strangers(bundle)
    if strange:
        names = ", ".join(shown(bundle.folder / path) for path in strange)
        rule = "running it would run code that this machine does not know"
        raise Untrusted(f"{bundle.folder}: {rule}: {names}; read these files, then use --trust.")


def strangers(bundle: Bundle) -> list[str]:
    """The component files in Python that this machine does not know, as paths in the bundle."""
    known = _known_here() | set(_shipped())
    return [path for path, digest in _code_in(bundle).items() if digest not in known]


def _code_in(bundle: Bundle) -> dict[str, str]:
    """The digest of each component in Python, by its path in the bundle."""
    return {path: digest_of(text) for path, text in sorted(bundle.files.items()) if path.endswith(".py")}


def _shipped() -> Iterable[str]:
    return (digest_of(as_lines(path.read_text(encoding="utf-8"))) for path in shipped_folder().glob("*/*.py"))


def _known_here() -> set[str]:
    folder = state_folder()
    try:
        return set((folder / _MEMORY).read_text(encoding="utf-8").split()) if folder else set()
    except (OSError, UnicodeDecodeError):
        return set()
