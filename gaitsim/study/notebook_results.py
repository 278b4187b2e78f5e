"""What a notebook calls for whole results: compared, written for a colleague, and put among one's own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from gaitsim.folders import results_folder
from gaitsim.study.listening import LogListener
from gaitsim.study.notebook import File, opening

if TYPE_CHECKING:
    from gaitsim.results.copies import Copy
    from gaitsim.study.comparison import Comparison


def compare(
    first: File,
    second: File,
    *,
    figures: bool = True,
    folder: File | None = None,
    trust: bool = False,
    library: Sequence[File] = (),
    results: File | None = None,
) -> Comparison:
    """Compare two results or specs: models part by part and value by value, then metrics and gaits.

    Args:
        first: A result folder or a spec.
        second: A result folder or a spec, compared with the first.
        figures: Whether the runs are drawn over one another.
        folder: Where the figures go; None for a folder in the second result.
        trust: Run components of a result that this machine does not know.
        library: More folders of components.
        results: Where names of results are looked up; None for $GAITSIM_RESULTS, or else results.

    Returns:
        `changes` of the models, each with `what`, `where`, `first` and `second`; `metrics` and `gait`, pairs of numbers
        with `name`, `unit`, `first` and `second`; `products` with the figures.

    Raises:
        GaitsimError: One of them cannot be opened, or nothing can be written.
    """
    from gaitsim.study.comparison import compared

    one, other = (opening(path, None, library, False, trust, None, results) for path in (first, second))
    return compared(one, other, LogListener(), figures, None if folder is None else Path(folder))


def export_result(path: File, out: File | None = None, *, results: File | None = None) -> Path:
    """Write a result as one zip file for a colleague.

    Args:
        path: A result folder.
        out: The file; None for RESULT.zip in this folder.
        results: Where the name of a result is looked up; None for $GAITSIM_RESULTS, or else results.

    Returns:
        The file. The same result gives the same bytes.

    Raises:
        GaitsimError: There is no such result, or the file cannot be written.
    """
    from gaitsim.results.manifest import result_named
    from gaitsim.results.packing import pack

    named = result_named(Path(path), None if results is None else Path(results))
    target = Path(f"{named.resolve().name}.zip") if out is None else Path(out)
    pack(named, target)
    return target


@dataclass(frozen=True)
class Imported:
    """A colleague's result among one's own.

    Attributes:
        folder: For `gaitsim.load`.
        copies: Its component files, each with `path`, `same` (as in a library of yours) and `strange` (not known to
            this machine).
        changed: What it was made with that differs here.
    """

    folder: Path
    copies: Sequence[Copy]
    changed: Sequence[str]

    def __repr__(self) -> str:
        strange = [copy.path for copy in self.copies if copy.strange]
        code = f"code that this machine does not know: {', '.join(strange)}" if strange else "no unknown code"
        return f"<Imported: {self.folder}; {code}>"


def import_result(file: File, *, results: File | None = None) -> Imported:
    """Put a colleague's result among yours; nothing of it is run.

    Args:
        file: A zip file that `export_result` or `gaitsim results export` made.
        results: Where it goes; None for $GAITSIM_RESULTS, or else results.

    Returns:
        Its folder, and which code it brings.

    Raises:
        GaitsimError: The file is not a result or damaged, or one of its name is there.
    """
    from gaitsim.components.find import library_folders
    from gaitsim.results.copies import copies
    from gaitsim.results.manifest import changed_makers, read_result
    from gaitsim.results.packing import unpack

    made = unpack(Path(file), results_folder(None if results is None else Path(results)))
    manifest, bundle = read_result(made)
    return Imported(made, copies(bundle, library_folders(None)), changed_makers(manifest))
