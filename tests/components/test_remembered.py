"""A component file that was found sound is not checked again, and what was remembered of it is not trusted blindly."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from gaitsim.components import load
from gaitsim.components.checks import audit, audited
from gaitsim.components.checks.shared import Shared
from gaitsim.components.find import Library
from gaitsim.components.primitive import Primitive
from gaitsim.distribution import shipped_folder

MUSCLE = shipped_folder() / "muscle" / "geyer2003.py"


def loaded() -> Primitive:
    text = MUSCLE.read_text(encoding="utf-8")
    shared = Library((shipped_folder(),)).shared("muscle", text)
    return load.load_primitive("muscle/geyer2003", MUSCLE, "geyer2003.py", text, shared)


@pytest.fixture
def cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv("GAITSIM_CACHE", str(tmp_path))
    return tmp_path


@pytest.fixture
def audits(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    done: list[str] = []
    real = audit.audit

    def counted(source: str, file: str, shared: Sequence[Shared]) -> object:
        done.append(file)
        return real(source, file, shared)

    monkeypatch.setattr(audit, "audit", counted)
    return done


def test_a_sound_file_is_checked_once_and_keeps_what_was_found(cache: Path, audits: list[str]) -> None:
    first = loaded()
    again = loaded()
    assert audits == ["geyer2003.py"]
    assert again.findings == first.findings
    assert first.dependencies["force"]


@pytest.mark.parametrize("damage", [b"", b"{", b"[]", b"3", b'{"force": 1}', b"\xff"])
def test_a_damaged_memory_is_made_again(cache: Path, audits: list[str], damage: bytes) -> None:
    first = loaded()
    (memory,) = (cache / "audited").iterdir()
    memory.write_bytes(damage)
    again = loaded()
    assert len(audits) == 2
    assert again.findings == first.findings
    assert audited.sound_findings(first.code) == first.findings


def test_without_a_place_to_remember_a_file_is_checked_each_time(
    audits: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("GAITSIM_CACHE", str(tmp_path / "file"))
    for _ in range(2):
        loaded()
    assert len(audits) == 2
