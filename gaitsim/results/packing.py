"""Export of a result to one file, and import. An imported file is checked before anything of it is written or run."""

from __future__ import annotations

import os
import re
import shutil
import stat
import zipfile
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path

from gaitsim.results.lock import state_of
from gaitsim.results.manifest import BadResult, read_result
from gaitsim.results.store import CannotSave
from gaitsim.whole import PARTIAL, whole

_FILES = re.compile(
    r"(manifest\.json|spec\.yaml|start\.json|cohort\.json|table\.csv|model\.yaml|model\.xml|README\.md|changes\.diff"
    r"|evaluations\.jsonl|arriving\.jsonl|generations\.csv|parameters\.csv|timings\.csv"
    r"|components/\w+/\w+\.(py|yaml|csv))"
)
_FOLDERS = re.compile(r"(components/(\w+/)?)?")
_NAME = re.compile(r"\w[\w.-]{0,199}")
_EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest date of a zip file
_MOST_FILES, _MOST_BYTES, _PIECE = 10_000, 2**30, 2**20
_ANEW = "ask for a file that gaitsim results export made"


def pack(folder: Path, target: Path) -> None:
    """Write a result as a zip file, with all that is needed to verify, resume and analyze it, and its notes.

    The same result gives the same bytes: files are in order and without dates. Figures, videos and reports are left
    out, because they can be made again.

    Raises:
        BadResult: The folder is not a result, is being written, or was edited.
        CannotSave: The file exists already, or cannot be written.
    """
    manifest, _ = read_result(folder)
    if state_of(folder, manifest["status"]) == "running":
        raise BadResult(f"{folder}: its search is running; wait for its end, or stop it and resume it later.")
    if target.exists():
        raise CannotSave(f"{target}: this exists already and is never overwritten; choose another --out.")
    inside = (path for path in sorted(folder.rglob("*")) if path.is_file())
    names = [name for path in inside if _FILES.fullmatch(name := path.relative_to(folder).as_posix())]
    try:
        with whole(target) as draft, zipfile.ZipFile(draft, "w") as file:
            for name in names:
                info = zipfile.ZipInfo(f"{folder.resolve().name}/{name}", _EPOCH)
                info.external_attr = (stat.S_IFREG | 0o644) << 16
                info.create_system = 3  # Unix, whatever this is
                file.writestr(info, (folder / name).read_bytes(), zipfile.ZIP_DEFLATED, 9)
    except OSError as error:
        raise CannotSave(f"{target}: this cannot be written ({error.strerror or error}); choose another --out.") from error


def unpack(archive: Path, root: Path) -> Path:
    """Add an exported result to the results in `root`. Nothing of it is run.

    Returns:
        Its folder.

    Raises:
        BadResult: The file is not a result, or has unexpected content. Nothing is left behind.
        CannotSave: There is a result of this name already, or the folder cannot be written.
    """
    try:
        with zipfile.ZipFile(archive) as file:
            return _unpacked(archive, file, root)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, ValueError) as error:
        raise BadResult(f"{archive}: this is not a zip file, or a damaged one ({error}); {_ANEW}.") from error
    except OSError as error:
        where = error.filename or archive
        raise CannotSave(f"{where}: {error.strerror or error}; choose another --results, or another file.") from error


def _unpacked(archive: Path, file: zipfile.ZipFile, root: Path) -> Path:
    entries = file.infolist()
    name = _checked(archive, entries)
    target = root / name
    if target.exists() or target.is_symlink():
        raise CannotSave(f"{target}: a result of this name exists already; nothing was changed. Choose another --results.")
    draft = root / f"{name}.{os.getpid()}{PARTIAL}"
    try:
        for entry in entries:
            if not entry.is_dir():
                place = draft / entry.filename.partition("/")[2]
                place.parent.mkdir(parents=True, exist_ok=True)
                with place.open("xb") as written:
                    for piece in _pieces(file, entry):
                        written.write(piece)
        try:
            read_result(draft)
        except BadResult as error:
            rules = "; ".join(str(fault).replace(str(draft), name) for fault in error.faults)
            raise BadResult(f"{archive}: nothing was imported. {rules}") from error
        draft.replace(target)
    except BaseException:
        shutil.rmtree(draft, ignore_errors=True)
        raise
    return target


def _checked(archive: Path, entries: Sequence[zipfile.ZipInfo]) -> str:
    """The name of the result in a file.

    Raises:
        BadResult: The file has something that export never writes.
    """
    for rule in _faults(entries):
        raise BadResult(f"{archive}: {rule}; nothing was imported. {_ANEW[0].upper()}{_ANEW[1:]}.")
    return entries[0].filename.partition("/")[0]


def _faults(entries: Sequence[zipfile.ZipInfo]) -> Iterator[str]:
    """Faults of the list of files, before a file is read."""
    if not entries:
        yield "it is empty"
    if len(entries) > _MOST_FILES:
        yield f"it holds {len(entries)} files, and a result has no more than {_MOST_FILES}"
    size = sum(entry.file_size for entry in entries)
    if size > _MOST_BYTES:
        yield f"it unpacks to {size / 2**30:.3g} GiB, more than {_MOST_BYTES / 2**30:g} GiB"
    seen: set[str] = set()
    for entry in entries:
        top, _, rest = entry.filename.partition("/")
        if not _NAME.fullmatch(top) or top.endswith(PARTIAL) or top != entries[0].filename.partition("/")[0]:
            yield f"{entry.filename!r} does not lie in one folder named after the result"
        kind = stat.S_IFMT(entry.external_attr >> 16)
        if kind not in (0, stat.S_IFDIR if entry.is_dir() else stat.S_IFREG):
            yield f"{entry.filename!r} is a link or a special file"
        if not (_FOLDERS if entry.is_dir() else _FILES).fullmatch(rest):
            yield f"{entry.filename!r} is not a file of a result"
        if entry.filename.lower() in seen:
            yield f"{entry.filename!r} is in it twice"
        if entry.flag_bits & 1:
            yield f"{entry.filename!r} is encrypted"
        seen.add(entry.filename.lower())


def _pieces(file: zipfile.ZipFile, entry: zipfile.ZipInfo) -> Iterator[bytes]:
    """The content of a file, up to its declared size."""
    with file.open(entry) as opened:
        while piece := opened.read(_PIECE):
            yield piece
