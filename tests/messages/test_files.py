"""Files that are no text of ours: each is refused in words, as a spec, as a parent and as a component."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from gaitsim.cli.main import main

SPEC = """\
gaitsim: 1
parts: {thing: {use: controller/thing}}
simulate: {duration: 1 s, step: 1 ms}
"""
UTF8 = "save it as text in UTF-8, or name another file."


def large(path: Path) -> None:
    with path.open("wb") as file:
        file.truncate(50_000_000)


def latin(path: Path) -> None:
    path.write_bytes("# für Ünsinn\n".encode("latin-1"))


def binary(path: Path) -> None:
    path.write_bytes(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR")


def link(path: Path) -> None:
    path.symlink_to("nowhere.yaml")


MADE: dict[str, tuple[Callable[[Path], None], str]] = {
    "large": (large, "this file has 50.0 MB and the limit is 5 MB; name a {what}, and keep data in other files."),
    "binary": (binary, f"byte 8 is NUL, so this is not a text in UTF-8; {UTF8}"),
    "latin": (latin, f"byte 3 (0xfc, in line 1) is not UTF-8; {UTF8}"),
}
ONLY_SPECS: dict[str, tuple[Callable[[Path], None], str]] = {
    "folder": (Path.mkdir, "this is a folder; it holds no .yaml file."),
    "link": (link, "this links to nowhere.yaml, which does not exist; correct the link."),
}
if hasattr(os, "mkfifo"):
    ONLY_SPECS["pipe"] = (os.mkfifo, "this is a pipe or a device; save the spec in a file and name it.")


@pytest.fixture
def said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[[str], str]:
    """What stands on stderr after a check that is refused."""
    monkeypatch.chdir(tmp_path)

    def check(spec: str) -> str:
        before = sorted(tmp_path.rglob("*"))
        with pytest.raises(SystemExit) as ended:
            main(["check", spec])
        out, err = capsys.readouterr()
        assert (ended.value.code, out) == (3, "")
        assert sorted(tmp_path.rglob("*")) == before
        return err

    return check


@pytest.mark.parametrize("name", MADE | ONLY_SPECS)
def test_as_a_spec(name: str, said: Callable[[str], str]) -> None:
    make, words = (MADE | ONLY_SPECS)[name]
    make(Path("a.yaml"))
    assert said("a.yaml") == f"a.yaml: {words.format(what='spec')}\n"


@pytest.mark.parametrize("name", MADE | ONLY_SPECS)
def test_as_a_parent(name: str, said: Callable[[str], str]) -> None:
    make, words = (MADE | ONLY_SPECS)[name]
    make(Path("a.yaml"))
    Path("b.yaml").write_text("extends: a.yaml\n")
    assert said("b.yaml") == (
        f"b.yaml:1:10: extends: a.yaml: {words.format(what='spec')}\n"
        "    1 | extends: a.yaml\n"
        "      |          ^\n"
    )


@pytest.mark.parametrize("suffix", [".py", ".yaml"])
@pytest.mark.parametrize("name", MADE)
def test_as_a_component(name: str, suffix: str, said: Callable[[str], str]) -> None:
    make, words = MADE[name]
    path = Path(f"components/controller/thing{suffix}")
    path.parent.mkdir(parents=True)
    make(path)
    Path("a.yaml").write_text(SPEC)
    assert said("a.yaml") == f"{path}: {words.format(what='component')}\n"


@pytest.mark.parametrize("path", ["a.yaml", "components/controller/thing.py", "components/controller/thing.yaml"])
def test_without_permission(path: str, said: Callable[[str], str], monkeypatch: pytest.MonkeyPatch) -> None:
    Path("components/controller").mkdir(parents=True)
    Path("a.yaml").write_text(SPEC)
    Path(path).touch()
    plain = Path.read_bytes

    # Tests may run as root, who may read everything.
    def denied(self: Path) -> bytes:
        if self.name == Path(path).name:
            raise PermissionError(13, "Permission denied")
        return plain(self)

    monkeypatch.setattr(Path, "read_bytes", denied)
    assert said("a.yaml") == f"{path}: there is no permission to read it; allow it with: chmod u+r {path}\n"
