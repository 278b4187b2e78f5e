"""Locks of result folders. A folder has one writer; the lock of a writer that died does not count."""

from __future__ import annotations

import contextlib
import json
import math
import os
import socket
import time
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from gaitsim.errors import GaitsimError

_WRITING = 5.0  # seconds after which an empty lock is not being written any more
_BEGUN = "another process began to write this result"


class Locked(GaitsimError):
    """Another process writes this result."""


class Lock:
    """Holds the file `lock` in a folder during a block.

    It is a plain file, because locks of the operating system fail on network drives.
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
                mine = {"host": socket.gethostname(), "process": os.getpid(), "began": _began(os.getpid())}
                json.dump(mine, file)
            return self
        raise Locked(f"{self._path}: {_BEGUN}; try again.")

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._path.unlink(missing_ok=True)

    def _remove_if_stale(self) -> None:
        holder = _holder(self._path)
        host, process = holder.get("host"), holder.get("process")
        if not holder and _age(self._path) < _WRITING:
            raise Locked(f"{self._path}: {_BEGUN}; try again.")
        if process != os.getpid() and _may_run(holder):
            rule = f"process {process} on {host} is writing this result"
            raise Locked(f"{self._path}: {rule}; wait for it, or remove this file if that process is gone.")
        # Only one process can rename it. If it changed meanwhile, another process was faster.
        aside = self._path.with_name(f"lock.{os.getpid()}.stale")
        with contextlib.suppress(FileNotFoundError):
            self._path.rename(aside)
            if _holder(aside) != holder:
                aside.rename(self._path)
                raise Locked(f"{self._path}: {_BEGUN}; try again.")
            aside.unlink()


def state_of(folder: Path, status: str) -> str:
    """The present status of a result.

    A process that died could not change the status `running`. A process on another machine is assumed to run, because
    this cannot be checked from here.

    Args:
        folder: The result.
        status: The status in its manifest.
    """
    if status != "running":
        return status
    path = folder / "lock"
    holder = _holder(path)
    if not holder:
        return "running" if _age(path) < _WRITING else "interrupted"
    return "running" if _may_run(holder) else "interrupted"


def _age(path: Path) -> float:
    try:
        return time.time() - path.stat().st_mtime
    except OSError:
        return math.inf


def _holder(path: Path) -> dict[str, Any]:
    """The content of a lock; empty if it is not written yet or cannot be read."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return data if isinstance(data, dict) else {}


def _may_run(holder: Mapping[str, Any]) -> bool:
    """Whether the process that holds a lock may still run. One on another machine may."""
    if holder.get("host") not in (None, socket.gethostname()):
        return True
    process = holder.get("process")
    if not isinstance(process, int):
        return False
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        pass
    # Numbers of ended processes are used again, soon after a restart of the machine.
    return holder.get("began") in (None, _began(process))


def _began(process: int) -> int | None:
    """The start of a process in ticks since boot; None if the system does not report it."""
    try:
        return int(Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[19])
    except (OSError, ValueError, IndexError):
        return None
