"""The versions of a component: in git, at present, and in results."""

from __future__ import annotations

import subprocess
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

from gaitsim.components.checks.shared import Shared, imported_names, whole
from gaitsim.components.find import Library, display_path
from gaitsim.components.load import as_lines, digest_of
from gaitsim.errors import Usage
from gaitsim.study.records import SHORT
from gaitsim.study.uses import UsingResult, UsingSpec

_FIELDS = "%x00%H%x1f%aI%x1f%an%x1f%s"
_UNCOMMITTED = "as it stands now"


@dataclass(frozen=True)
class Version:
    """One version of a component: the first letters of its digest, its date and origin, and its users.

    Attributes:
        origin: A commit with author and subject, a result, or the present file.
    """

    digest: str
    date: str
    origin: str
    present: bool
    users: tuple[str, ...] = field(default=())


@dataclass(frozen=True)
class _Commit:
    hash: str
    date: str
    author: str
    subject: str
    path: str

    @property
    def summary(self) -> str:
        return f"commit {self.hash[:8]} by {self.author}: {self.subject}"


def history(
    reference: str, library: Library, results: Iterable[UsingResult], specs: Iterable[UsingSpec]
) -> list[Version]:
    """All known versions of a component or a table, oldest first.

    Args:
        reference: The component, such as muscle/geyer2003.
        library: The library with the present version.
        results: Results with copies of it.
        specs: Specs that use the present version.

    Raises:
        Usage: Neither the library nor a result has such a component.
    """
    found: dict[str, tuple[str, str]] = {}
    users: dict[str, list[str]] = {}
    now = library.version(reference)
    path = library.file(reference)
    if path is not None and now is not None:
        for commit in _commits(path, library):
            digest = _at(commit, path.parent, library)
            if digest:
                found.setdefault(digest, (commit.date, commit.summary))
        found.setdefault(now[:SHORT], ("", _UNCOMMITTED))
    for result in results:
        found.setdefault(result.version, (result.created, f"result {display_path(result.folder)}"))
        users.setdefault(result.version, []).append(display_path(result.folder))
    if not found:
        raise Usage(library.unknown(reference))
    for spec in specs:
        users.setdefault(spec.version, []).append(spec.archived.name)
    rows = [
        Version(digest, date, origin, bool(now and now.startswith(digest)), tuple(users.get(digest, ())))
        for digest, (date, origin) in found.items()
    ]
    return sorted(rows, key=lambda each: (not each.date, each.date))


def _commits(path: Path, library: Library) -> Iterator[_Commit]:
    """The commits that changed a component or its shared files, oldest first; none outside of git.

    Each has the path that the component had then.
    """
    text = path.read_text(encoding="utf-8")
    shared = library.shared(path.parent.name, text) if path.suffix == ".py" else []
    own = _log(path, "--follow")
    here = own[0].path if own else ""
    others = [replace(each, path=here) for file in shared for each in _log(file.path)]
    yield from sorted({each.hash: each for each in (*others[::-1], *own[::-1])}.values(), key=lambda each: each.date)


def _log(path: Path, *options: str) -> list[_Commit]:
    text = _git(path.parent, "log", *options, f"--format={_FIELDS}", "--name-only", "--", path.name)
    commits = []
    for piece in text.split("\0")[1:]:
        head, *names = [line for line in piece.splitlines() if line]
        commit, day, author, subject = head.split("\x1f")
        commits.append(_Commit(commit, day, author, subject, names[-1] if names else ""))
    return commits


def _at(commit: _Commit, folder: Path, library: Library) -> str:
    """The version of a component at a commit; empty if it did not exist.

    A shared file in another library is taken as it is now.
    """
    text = _git(folder, "cat-file", "blob", f"{commit.hash}:{commit.path}")
    if not text:
        return ""
    text, home = as_lines(text.removeprefix("\ufeff")), commit.path.rpartition("/")[0]
    now = {file.name: file for file in library.shared(folder.name, text)} if commit.path.endswith(".py") else {}
    shared = []
    for name in imported_names(text) if commit.path.endswith(".py") else ():
        then = _git(folder, "cat-file", "blob", f"{commit.hash}:{home}/{name}.py")
        shared += [Shared(name, folder, name, as_lines(then))] if then else [now[name]] if name in now else []
    return digest_of(whole(text, shared))[:SHORT]


def _git(folder: Path, *arguments: str) -> str:
    """The output of git; empty outside of a checkout, or without git."""
    # A checkout can configure a file monitor, which git would start.
    command = ["git", "-c", "core.fsmonitor=false", "-c", "core.quotePath=false", *arguments]
    try:
        ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=30, encoding="utf-8")
    except (OSError, subprocess.SubprocessError, UnicodeDecodeError):
        return ""
    return ran.stdout if ran.returncode == 0 else ""
