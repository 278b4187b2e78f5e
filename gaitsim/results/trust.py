"""Trust in component files: those that come with gaitsim and those that were run here before may run without asking.

The location of a result, and the current folder, do not say who wrote it.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterable

from gaitsim.errors import GaitsimError
from gaitsim.folders import state_folder
from gaitsim.components.find import display_path
from gaitsim.distribution import shipped_folder
from gaitsim.components.load import as_lines, digest_of
from gaitsim.results.bundle import Bundle

_MEMORY = "known_components"


class Untrusted(GaitsimError):
    """A result has code that this machine does not know."""


def remember(bundle: Bundle) -> None:
    """Store that the components of a bundle were run here."""
    known, folder = _known_here(), state_folder()
    new = [digest for digest in _code_in(bundle).values() if digest not in known]
    if new and folder is not None:
        # If this cannot be written, --trust is needed later; the run continues.
        with contextlib.suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            with (folder / _MEMORY).open("a", encoding="utf-8") as file:
                file.writelines(f"{digest}\n" for digest in new)


def check_trust(bundle: Bundle, trusted: bool) -> None:
    """Check that the components of a result are known.

    Args:
        bundle: The bundle of the result.
        trusted: Whether the user trusts it.

    Raises:
        Untrusted: Components are not known and the user did not say so.
    """
    if trusted:
        return
    strange = unknown_components(bundle)
    if strange:
        names = ", ".join(display_path(bundle.folder / path) for path in strange)
        rule = "running it would run code that this machine does not know"
        raise Untrusted(f"{bundle.folder}: {rule}: {names}; read these files, then use --trust.")


def unknown_components(bundle: Bundle) -> list[str]:
    """The Python component files that this machine does not know, as paths in the bundle."""
    known = _known_here() | set(_shipped())
    return [path for path, digest in _code_in(bundle).items() if digest not in known]


def _code_in(bundle: Bundle) -> dict[str, str]:
    """The digest of each Python component, by its path in the bundle."""
    return {path: digest_of(text) for path, text in sorted(bundle.files.items()) if path.endswith(".py")}


def _shipped() -> Iterable[str]:
    return (digest_of(as_lines(path.read_text(encoding="utf-8"))) for path in shipped_folder().glob("*/*.py"))


def _known_here() -> set[str]:
    folder = state_folder()
    try:
        return set((folder / _MEMORY).read_text(encoding="utf-8").split()) if folder else set()
    except (OSError, UnicodeDecodeError):
        return set()
