"""The component files of a result, compared with those of one's own libraries."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from gaitsim.components.find import display_path
from gaitsim.distribution import shipped_folder
from gaitsim.components.load import as_lines
from gaitsim.components.places import serves
from gaitsim.results.bundle import COMPONENTS, Bundle
from gaitsim.results.trust import unknown_components


@dataclass(frozen=True)
class Copy:
    """One component file of a result.

    Attributes:
        library: The library with a file of this name: shipped, lab, project, or a folder; empty for none.
        same: Whether that file is the same.
        strange: Whether this machine does not know the code.
    """

    path: str
    library: str
    same: bool
    strange: bool

    @property
    def comparison(self) -> str:
        """The comparison in words."""
        if not self.library:
            return "not in your libraries"
        return f"{'same as' if self.same else 'differs from'} {self.library}"


def copies(bundle: Bundle, folders: Sequence[Path]) -> list[Copy]:
    """Compare the component files of a bundle with those in folders.

    Args:
        bundle: The bundle of a result.
        folders: Folders of components; the first one with a file of the same name counts.
    """
    strange = set(unknown_components(bundle))
    found = []
    for path, text in sorted(bundle.files.items()):
        inner = path.removeprefix(f"{COMPONENTS}/")
        if inner == path:
            continue
        folder = next((folder for folder in folders if (folder / inner).is_file()), None)
        word = "" if folder is None else _word(folder)
        same = folder is not None and as_lines((folder / inner).read_text(encoding="utf-8")) == text
        found.append(Copy(path, word, same, path in strange))
    return found


def _word(folder: Path) -> str:
    word = serves(folder, shipped_folder())
    return display_path(folder) if word == str(folder) else word
