"""One writer for a result folder; a writer that died does not hold it."""

from __future__ import annotations

import json
import os
import socket
from pathlib import Path
from types import TracebackType
from typing import Any

from gaitsim.errors import GaitsimError


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
        raise Locked(f"{self._path}: another process began to write this result; try again.")

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._path.unlink(missing_ok=True)

    def _remove_if_stale(self) -> None:
        holder = self._holder()
        host, process = holder.get("host"), holder.get("process")
        here = host in (None, socket.gethostname())
        if here and not (isinstance(process, int) and process != os.getpid() and _alive(process)):
            self._path.unlink(missing_ok=True)
            return
        rule = f"process {process} on {host} is writing this result"
        raise Locked(f"{self._path}: {rule}; wait for it, or remove this file if that process is gone.")

    def _holder(self) -> dict[str, Any]:
        try:
            data = json.loads(self._path.read_text(encoding="utf-8"))
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
