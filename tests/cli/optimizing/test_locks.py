"""One process writes a result at a time."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from .files import content, rewritten


def held(folder: Path, process: int, host: str = "", began: int | None = None) -> None:
    found = {"host": host or socket.gethostname(), "process": process, "began": began}
    (folder / "lock").write_text(json.dumps(found))


def test_a_locked_result(begun: Path, command: Any) -> None:
    held(begun, os.getppid())
    before = content(begun)
    ended = command("optimize", str(begun), "--resume", "--generations", "3", "--workers", "0")
    assert ended.code == 3
    assert f"{begun}/lock: process {os.getppid()} on " in ended.err
    assert "is writing this result; wait for it, or remove this file if that process is gone." in ended.err
    assert content(begun) == before


@pytest.mark.parametrize("garbage", [False, True])
def test_a_lock_of_a_dead_process(begun: Path, command: Any, garbage: bool) -> None:
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    held(begun, dead.pid)
    if garbage:
        (begun / "lock").write_text("")
        os.utime(begun / "lock", (1, 1))
    assert command("optimize", str(begun), "--resume", "--generations", "3", "--workers", "0").code == 0
    assert not list(begun.glob("lock*"))


def test_a_lock_whose_number_another_process_has_now(begun: Path, command: Any) -> None:
    held(begun, os.getppid(), began=1)
    assert command("optimize", str(begun), "--resume", "--generations", "3", "--workers", "0").code == 0
    assert not list(begun.glob("lock*"))


def test_a_state_is_that_of_who_holds_the_lock(begun: Path, command: Any) -> None:
    def state() -> str:
        (row,) = command("results", "list", "--json").data["results"]
        assert command("results", "show", str(begun), "--json").data["status"] == row["status"]
        return str(row["status"])

    held(begun, os.getppid())
    assert state() == "complete"
    rewritten(begun / "manifest.json", ('"status": "complete"', '"status": "running"'))
    assert state() == "running"
    held(begun, os.getppid(), began=1)
    assert state() == "interrupted"
    held(begun, os.getppid(), host="elsewhere")
    assert state() == "running"  # from here no one can tell
    (begun / "lock").write_text("")
    assert state() == "running"  # it is being written
    os.utime(begun / "lock", (1, 1))
    assert state() == "interrupted"
    (begun / "lock").unlink()
    assert state() == "interrupted"


def test_a_lock_that_is_just_being_written(begun: Path, command: Any) -> None:
    (begun / "lock").write_text("")
    ended = command("optimize", str(begun), "--resume", "--generations", "3", "--workers", "0")
    assert (ended.code, "another process began to write this result; try again." in ended.err) == (3, True)
