"""Machine code is kept between processes; a cache that cannot be used ends nothing and is told of once."""

from __future__ import annotations

import ctypes
import resource
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from gaitsim import cache
from gaitsim.compiler import machine

TESTS = Path(__file__).parents[1]
TEXT = "define double @thrice(double %x) {\n  %y = fmul double %x, 3.0\n  ret double %y\n}\n"
DEAD_END = "so nothing is kept and each run compiles again; set GAITSIM_CACHE to a folder that can be written"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A cache of this test's own, in a process that has said nothing yet."""
    said = list(cache._warnings())
    cache._warnings().clear()
    monkeypatch.setenv("GAITSIM_CACHE", str(tmp_path / "cache"))
    yield tmp_path / "cache"
    cache._warnings()[:] = said


def thrice(number: float) -> float:
    code = machine.code("trials", "thrice", lambda: machine.object_file(machine.linked(TEXT, []), ["thrice"]))
    return float(ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(code.address("thrice"))(number))


def said(caplog: pytest.LogCaptureFixture) -> list[str]:
    found = [record.getMessage() for record in caplog.records]
    caplog.clear()
    return found


def test_what_was_compiled_once_is_taken_from_the_cache(
    folder: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert thrice(2.0) == 6.0
    (entry,) = (folder / "trials").iterdir()
    before = entry.stat()
    monkeypatch.setattr(machine, "object_file", None)
    assert thrice(2.0) == 6.0
    assert entry.stat().st_mtime_ns == before.st_mtime_ns
    assert said(caplog) == []


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: data[: len(data) // 2],
        lambda data: b"",
        lambda data: data[:-1] + bytes([data[-1] ^ 1]),
        lambda data: bytes([data[0] ^ 1]) + data[1:],
        lambda data: data + b"\0",
        lambda data: bytes(len(data)),
    ],
    ids=["truncated", "empty", "last bit", "first bit", "longer", "zeros"],
)
def test_a_damaged_entry_is_made_again(
    damage: Callable[[bytes], bytes], folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    assert thrice(2.0) == 6.0
    (entry,) = (folder / "trials").iterdir()
    entry.write_bytes(damage(entry.read_bytes()))
    assert thrice(2.0) == 6.0
    assert said(caplog) == [f"gaitsim: {entry} is damaged; it is made again."]
    assert thrice(2.0) == 6.0
    assert said(caplog) == []


def test_a_cache_that_is_a_file(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    folder.write_text("no folder")
    assert [thrice(2.0), thrice(3.0)] == [6.0, 9.0]
    assert said(caplog) == [f"gaitsim: the cache {folder} cannot be used (Not a directory), {DEAD_END}."]


def test_a_cache_where_no_folder_can_be_made(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    monkeypatch.setenv("GAITSIM_CACHE", "/dev/null/x")
    assert [thrice(2.0), thrice(3.0)] == [6.0, 9.0]
    assert said(caplog) == [f"gaitsim: the cache /dev/null/x cannot be used (Not a directory), {DEAD_END}."]


def test_a_full_cache_keeps_no_half_entry(folder: Path, caplog: pytest.LogCaptureFixture) -> None:
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))
    try:
        assert [thrice(2.0), thrice(3.0)] == [6.0, 9.0]
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert list((folder / "trials").iterdir()) == []
    assert said(caplog) == [f"gaitsim: the cache {folder} cannot be used (File too large), {DEAD_END}."]


def test_a_user_without_a_home(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    def nobody() -> Path:
        raise RuntimeError("Could not determine home directory.")

    for variable in ("GAITSIM_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setattr(Path, "home", nobody)
    assert [thrice(2.0), thrice(3.0)] == [6.0, 9.0]
    assert said(caplog) == [f"gaitsim: there is no absolute path to a cache folder, {DEAD_END}."]


def test_what_is_kept_needs_no_compiler(folder: Path) -> None:
    """Neither numba nor what translates is imported by a process that finds all in the cache."""
    text = """
import sys
from simulation.models import OWN, simulator
outcome = simulator(OWN / "tuned_rod.yaml", [("simulate.duration", "10 ms")]).run()
assert outcome.status == "completed", outcome.reason
print(sorted({"numba", "gaitsim.compiler.translation"} & set(sys.modules)))
"""
    imported = []
    for _ in range(2):
        done = subprocess.run([sys.executable, "-c", text], cwd=TESTS, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        imported.append(done.stdout)
    assert imported == ["['gaitsim.compiler.translation', 'numba']\n", "[]\n"]
