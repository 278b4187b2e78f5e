"""One writer for a result folder; a writer that died does not hold it."""

from __future__ import annotations

import contextlib
import json
import math
import os
import socket
import time
from pathlib import Path
from types import TracebackType
from typing import Any

from gaitsim.errors import GaitsimError

_WRITING = 5.0  # seconds after which a lock that names no process is not still being written
_BEGUN = "another process began to write this result"


class Locked(GaitsimError):
    """Another process writes this result."""


class Lock:
    """Holds `lock` in a folder while its block runs.

    A plain file rather than a lock of the operating system: those fail on network drives.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / "lock"

    def __enter__(self) -> Lock:
        for _ in range(2):
            try:
                descriptor = os.open(self._path, os.O_CREAT | os.O_EXCL | os.O_WRONLY)
            except FileExistsError:
                self._remove_if_stale()
                continue
            with os.fdopen(descriptor, "w", encoding="utf-8") as file:
                json.dump({"host": socket.gethostname(), "process": os.getpid()}, file)
            return self
        raise Locked(f"{self._path}: {_BEGUN}; try again.")

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._path.unlink(missing_ok=True)

    def _remove_if_stale(self) -> None:
        holder = _holder(self._path)
        host, process = holder.get("host"), holder.get("process")
        if not holder and self._age() < _WRITING:
            raise Locked(f"{self._path}: {_BEGUN}; try again.")
        here = host in (None, socket.gethostname())
        if not here or (isinstance(process, int) and process != os.getpid() and _alive(process)):
            rule = f"process {process} on {host} is writing this result"
            raise Locked(f"{self._path}: {rule}; wait for it, or remove this file if that process is gone.")
        # Taken aside by one process only; if it is not what was looked at, someone else was faster.
        aside = self._path.with_name(f"lock.{os.getpid()}.stale")
        with contextlib.suppress(FileNotFoundError):
            self._path.rename(aside)
            if _holder(aside) != holder:
                aside.rename(self._path)
                raise Locked(f"{self._path}: {_BEGUN}; try again.")
            aside.unlink()

    def _age(self) -> float:
        return _age(self._path)


def state_of(folder: Path, status: str) -> str:
    """What a result's status is by now: who died while it was `running` could not write another.

    On another machine's word alone a process runs: from here that cannot be seen.
    """
    if status != "running":
        return status
    path = folder / "lock"
    holder = _holder(path)
    if not holder:
        return "running" if _age(path) < _WRITING else "interrupted"
    host, process = holder.get("host"), holder.get("process")
    here = host in (None, socket.gethostname())
    return "interrupted" if here and not (isinstance(process, int) and _alive(process)) else "running"


def _age(path: Path) -> float:
    try:
        return time.time() - path.stat().st_mtime
    except OSError:
        return math.inf


def _holder(path: Path) -> dict[str, Any]:
    """Who holds a lock; nothing if that is not written yet, or is garbage."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return data if isinstance(data, dict) else {}


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
