"""A scheduler and workers, started by hand in other folders."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

DASK = str(Path(sys.executable).with_name("dask"))


class Servers:
    """One scheduler and its workers; everything ends with the test."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.file = folder / "scheduler.json"
        self.processes: list[subprocess.Popen[bytes]] = []
        self.scheduler = self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        end = time.monotonic() + 60
        while not self.file.exists():
            assert time.monotonic() < end and self.scheduler.poll() is None
            time.sleep(0.05)

    def worker(self, *words: str, **environment: str) -> subprocess.Popen[bytes]:
        """A worker in a folder of its own."""
        return self._start("worker", "--nthreads", "1", "--no-dashboard", *words, **environment)

    def _start(self, kind: str, *words: str, **environment: str) -> subprocess.Popen[bytes]:
        place = self.folder / f"{kind}{len(self.processes)}"
        place.mkdir()
        log = (place / "log").open("wb")
        command = [DASK, kind, "--scheduler-file", str(self.file), *words]
        variables = {**os.environ, **environment}
        process = subprocess.Popen(command, cwd=place, stdout=log, stderr=log, env=variables, start_new_session=True)
        self.processes.append(process)
        return process

    @property
    def address(self) -> str:
        import json

        return str(json.loads(self.file.read_text())["address"])

    @property
    def words(self) -> list[str]:
        return ["--cluster", "--scheduler-file", str(self.file)]

    def wait_for_workers(self, count: int) -> None:
        with client(self.address) as found:
            found.wait_for_workers(count, timeout=60)

    def end(self) -> None:
        for process in reversed(self.processes):
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


@contextmanager
def client(address: str) -> Iterator[Any]:
    from distributed import Client

    found = Client(address, set_as_default=False)
    try:
        yield found
    finally:
        found.close()


def children(process: int) -> list[int]:
    """The processes below a process, and theirs."""
    import psutil

    return [child.pid for child in psutil.Process(process).children(recursive=True)]
